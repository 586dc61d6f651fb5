// SPDX-License-Identifier: Apache-2.0
// A Cyclone DDS program that does less than the README asks of it: as soon as both ends have
// matched it lists the models, by one request that is written once.
//
//   cyclone_once DOMAIN
//
// Exit code 0 when the reply came within 3 s.

#include <dds/dds.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tracker_requests.h"

static bool is_matched(dds_entity_t writer, dds_entity_t reader) {
    dds_publication_matched_status_t out;
    dds_subscription_matched_status_t in;
    dds_get_publication_matched_status(writer, &out);
    dds_get_subscription_matched_status(reader, &in);
    return out.current_count > 0 && in.current_count > 0;
}

// Whether a reply is there, and it is to this writer.
static bool is_answered(dds_entity_t reader, const dds_guid_t* writer) {
    void* samples[1] = {NULL};
    dds_sample_info_t info;
    if (dds_take(reader, samples, &info, 1, 1) != 1) return false;
    const pursuit_v1_TrackerReply* reply = samples[0];
    const bool ours = info.valid_data && memcmp(reply->header.related_request_id.writer_guid,
                                                writer->v, sizeof writer->v) == 0;
    dds_return_loan(reader, samples, 1);
    return ours;
}

int main(int argc, char** argv) {
    if (argc != 2) {
        fprintf(stderr, "cyclone_once DOMAIN\n");
        return 2;
    }
    const dds_entity_t participant =
        dds_create_participant((dds_domainid_t)atoi(argv[1]), NULL, NULL);
    const dds_entity_t requests = dds_create_topic(participant, &pursuit_v1_TrackerRequest_desc,
                                                   "pursuit/tracker/request", NULL, NULL);
    const dds_entity_t replies = dds_create_topic(participant, &pursuit_v1_TrackerReply_desc,
                                                  "pursuit/tracker/reply", NULL, NULL);
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 128);
    const dds_entity_t writer = dds_create_writer(participant, requests, qos, NULL);
    const dds_entity_t reader = dds_create_reader(participant, replies, qos, NULL);
    dds_delete_qos(qos);
    if (writer < 0 || reader < 0) {
        fprintf(stderr, "cannot join DDS domain %s\n", argv[1]);
        return 1;
    }
    for (int i = 0; i < 1000 && !is_matched(writer, reader); ++i) dds_sleepfor(DDS_MSECS(10));

    pursuit_v1_TrackerRequest request;
    memset(&request, 0, sizeof request);
    request.call._d = pursuit_v1_TRACKER_LIST_MODELS;
    dds_guid_t guid;
    dds_get_guid(writer, &guid);
    memcpy(request.header.request_id.writer_guid, guid.v, sizeof guid.v);
    request.header.request_id.sequence_low = 1;
    dds_write(writer, &request);
    bool answered = false;
    for (int i = 0; i < 300 && !answered; ++i) {
        answered = is_answered(reader, &guid);
        if (!answered) dds_sleepfor(DDS_MSECS(10));
    }
    if (!answered) fprintf(stderr, "no reply within 3 s\n");
    dds_delete(participant);
    return answered ? 0 : 1;
}
