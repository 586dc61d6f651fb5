// SPDX-License-Identifier: Apache-2.0
// What another vendor's user would write: a Cyclone DDS program, made from the same IDL, that
// registers a model by request, lists the models, and receives the poses.
//
//   cyclone_client DOMAIN MODEL.csv NAME X Y THETA POSES SECONDS
//
// Prints a line a step; exit code 0 when every reply came and POSES poses of NAME were received.

#include <dds/dds.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "poses.h"
#include "tracker_requests.h"

enum { most_points = 4096 };

static void check(dds_return_t code, const char* what) {
    if (code < 0) {
        fprintf(stderr, "%s: %s\n", what, dds_strretcode(-code));
        exit(1);
    }
}

static dds_qos_t* reliable(int depth) {
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, depth);
    dds_qset_durability(qos, DDS_DURABILITY_VOLATILE);
    return qos;
}

static uint32_t read_points(const char* path, pursuit_v1_ModelPoint* points) {
    FILE* file = fopen(path, "r");
    if (file == NULL) {
        perror(path);
        exit(1);
    }
    char line[256];
    uint32_t count = 0;
    while (count < most_points && fgets(line, sizeof line, file) != NULL) {
        if (sscanf(line, "%f,%f", &points[count].x_px, &points[count].y_px) == 2) ++count;
    }
    fclose(file);
    return count;
}

static void wait_for_service(dds_entity_t writer, dds_entity_t reader) {
    for (int i = 0; i < 1000; ++i) {
        dds_publication_matched_status_t out;
        dds_subscription_matched_status_t in;
        check(dds_get_publication_matched_status(writer, &out), "matched");
        check(dds_get_subscription_matched_status(reader, &in), "matched");
        if (out.current_count > 0 && in.current_count > 0) return;
        dds_sleepfor(DDS_MSECS(10));
    }
    fprintf(stderr, "no tracker answers\n");
    exit(1);
}

// Sends the request under a new id and gives the reply to it; the replies to others are left. A
// reader that has just been matched may miss a reply, so the same request, under the same id, is
// written again every 500 ms: it is answered again, and not applied again.
static pursuit_v1_TrackerReply* call(dds_entity_t writer, dds_entity_t reader,
                                     pursuit_v1_TrackerRequest* request) {
    static uint32_t sequence = 0;
    dds_guid_t guid;
    check(dds_get_guid(writer, &guid), "dds_get_guid");
    pursuit_v1_RequestId* id = &request->header.request_id;
    memcpy(id->writer_guid, guid.v, 16);
    id->sequence_high = 0;
    id->sequence_low = ++sequence;
    for (int i = 0; i < 500; ++i) {
        if (i % 50 == 0) check(dds_write(writer, request), "dds_write");
        void* samples[1] = {NULL};
        dds_sample_info_t info;
        const int taken = dds_take(reader, samples, &info, 1, 1);
        check(taken, "dds_take");
        if (taken == 1 && info.valid_data) {
            pursuit_v1_TrackerReply* reply = samples[0];
            const pursuit_v1_RequestId* related = &reply->header.related_request_id;
            if (memcmp(related->writer_guid, guid.v, 16) == 0 &&
                related->sequence_low == sequence && related->sequence_high == 0) {
                return reply;
            }
        }
        if (taken == 1) dds_return_loan(reader, samples, 1);
        dds_sleepfor(DDS_MSECS(10));
    }
    fprintf(stderr, "no reply to request %u\n", sequence);
    exit(1);
}

int main(int argc, char** argv) {
    if (argc != 9) {
        fprintf(stderr, "cyclone_client DOMAIN MODEL.csv NAME X Y THETA POSES SECONDS\n");
        return 2;
    }
    const char* name = argv[3];
    const int wanted = atoi(argv[7]);
    const double seconds = atof(argv[8]);

    const dds_entity_t participant =
        dds_create_participant((dds_domainid_t)atoi(argv[1]), NULL, NULL);
    check(participant, "participant");
    dds_qos_t* calls = reliable(128);
    dds_qos_t* poses = reliable(16);
    const dds_entity_t request_topic = dds_create_topic(
        participant, &pursuit_v1_TrackerRequest_desc, "pursuit/tracker/request", NULL, NULL);
    const dds_entity_t reply_topic = dds_create_topic(participant, &pursuit_v1_TrackerReply_desc,
                                                      "pursuit/tracker/reply", NULL, NULL);
    const dds_entity_t pose_topic =
        dds_create_topic(participant, &pursuit_v1_ObjectPose_desc, "pursuit/poses", NULL, NULL);
    check(request_topic, "request topic");
    check(reply_topic, "reply topic");
    check(pose_topic, "pose topic");
    const dds_entity_t writer = dds_create_writer(participant, request_topic, calls, NULL);
    const dds_entity_t reader = dds_create_reader(participant, reply_topic, calls, NULL);
    const dds_entity_t pose_reader = dds_create_reader(participant, pose_topic, poses, NULL);
    check(writer, "request writer");
    check(reader, "reply reader");
    check(pose_reader, "pose reader");
    wait_for_service(writer, reader);

    static pursuit_v1_ModelPoint points[most_points];
    pursuit_v1_TrackerRequest request;
    memset(&request, 0, sizeof request);
    request.call._d = pursuit_v1_TRACKER_REGISTER_MODEL;
    pursuit_v1_RegisterModel* model = &request.call._u.register_model;
    snprintf(model->name, sizeof model->name, "%s", name);
    model->start.mode = pursuit_v1_START_POSE;
    model->start.x_px = atof(argv[4]);
    model->start.y_px = atof(argv[5]);
    const double theta_rad = atof(argv[6]);
    model->start.a00 = model->start.a11 = cos(theta_rad);
    model->start.a10 = sin(theta_rad);
    model->start.a01 = -sin(theta_rad);
    model->points._length = model->points._maximum = read_points(argv[2], points);
    model->points._buffer = points;
    pursuit_v1_TrackerReply* reply = call(writer, reader, &request);
    printf("register: code %d \"%s\" object %u effective %lld\n", (int)reply->outcome.code,
           reply->outcome.message, reply->result._u.register_model.object_id,
           (long long)reply->effective_time_us);
    if (reply->outcome.code != pursuit_v1_STATUS_OK) return 1;

    memset(&request, 0, sizeof request);
    request.call._d = pursuit_v1_TRACKER_LIST_MODELS;
    reply = call(writer, reader, &request);
    int listed = 0;
    for (uint32_t i = 0; i < reply->result._u.list_models.names._length; ++i) {
        listed += strcmp(reply->result._u.list_models.names._buffer[i], name) == 0;
    }
    printf("list: code %d, \"%s\" listed %d time(s)\n", (int)reply->outcome.code, name, listed);
    if (listed != 1) return 1;

    // A call that must be refused, in words that name the field.
    memset(&request, 0, sizeof request);
    request.call._d = pursuit_v1_TRACKER_REMOVE_MODEL;
    snprintf(request.call._u.remove_model.name, sizeof request.call._u.remove_model.name,
             "no-such-model");
    reply = call(writer, reader, &request);
    printf("remove: code %d \"%s\"\n", (int)reply->outcome.code, reply->outcome.message);
    if (reply->outcome.code != pursuit_v1_STATUS_NOT_FOUND) return 1;

    int received = 0;
    pursuit_v1_ObjectPose last;
    memset(&last, 0, sizeof last);
    const dds_time_t end = dds_time() + (dds_duration_t)(seconds * 1e9);
    while (received < wanted && dds_time() < end) {
        void* samples[64] = {NULL};
        dds_sample_info_t info[64];
        const int taken = dds_take(pose_reader, samples, info, 64, 64);
        check(taken, "dds_take");
        for (int i = 0; i < taken; ++i) {
            const pursuit_v1_ObjectPose* pose = samples[i];
            if (!info[i].valid_data || strcmp(pose->model, name) != 0) continue;
            last = *pose;
            ++received;
        }
        if (taken > 0) dds_return_loan(pose_reader, samples, taken);
        dds_sleepfor(DDS_MSECS(2));
    }
    printf("poses: %d of \"%s\", the last at %lld us: %.3f %.3f px, %.4f rad, state %d\n", received,
           name, (long long)last.t_us, last.x_px, last.y_px, last.theta_rad, (int)last.state);
    dds_delete_qos(calls);
    dds_delete_qos(poses);
    dds_delete(participant);
    return received >= wanted ? 0 : 1;
}
