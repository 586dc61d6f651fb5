// SPDX-License-Identifier: Apache-2.0
// The smallest program of another vendor's DDS that follows the poses (idl/README.md builds it by
// hand): a line a pose, and what of them did not come.
//
//   print_poses DOMAIN COUNT SECONDS
//
// Exit code 0 when COUNT poses came within SECONDS.

#include <dds/dds.h>
#include <stdio.h>
#include <stdlib.h>

#include "poses.h"

enum { most_at_once = 16, most_objects = 257 };

int main(int argc, char** argv) {
    if (argc != 4) {
        fprintf(stderr, "print_poses DOMAIN COUNT SECONDS\n");
        return 2;
    }
    const int wanted = atoi(argv[2]);
    const dds_time_t until = dds_time() + DDS_SECS(atoi(argv[3]));

    const dds_entity_t participant =
        dds_create_participant((dds_domainid_t)atoi(argv[1]), NULL, NULL);
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 16);
    const dds_entity_t topic =
        dds_create_topic(participant, &pursuit_v1_ObjectPose_desc, "pursuit/poses", NULL, NULL);
    const dds_entity_t reader = dds_create_reader(participant, topic, qos, NULL);
    dds_delete_qos(qos);
    if (participant < 0 || topic < 0 || reader < 0) {
        fprintf(stderr, "DDS: %s\n", dds_strretcode(-reader));
        return 1;
    }

    static const char* const states[] = {"SEARCHING", "TRACKING", "OCCLUDED", "LOST"};
    unsigned long long last[most_objects] = {0};  // sequence number of each object
    unsigned long long missed = 0;
    int count = 0;
    while (count < wanted && dds_time() < until) {
        void* samples[most_at_once] = {NULL};
        dds_sample_info_t infos[most_at_once];
        const int taken = dds_take(reader, samples, infos, most_at_once, most_at_once);
        if (taken < 0) {
            fprintf(stderr, "dds_take: %s\n", dds_strretcode(-taken));
            return 1;
        }
        for (int i = 0; i < taken; ++i) {
            if (!infos[i].valid_data) continue;  // an object is gone: its state is in infos[i]
            const pursuit_v1_ObjectPose* pose = samples[i];
            unsigned long long* before = &last[pose->object_id % most_objects];
            if (*before != 0 && pose->sequence_number > *before + 1) {
                missed += pose->sequence_number - *before - 1;
            }
            *before = pose->sequence_number;
            printf("%lld us  %s  %s  confidence %.2f  (%.2f, %.2f) px  %.4f rad\n",
                   (long long)pose->t_us, pose->model, states[pose->state & 3], pose->confidence,
                   pose->x_px, pose->y_px, pose->theta_rad);
            ++count;
        }
        if (taken > 0) dds_return_loan(reader, samples, taken);
        if (taken == 0) dds_sleepfor(DDS_MSECS(1));
    }
    printf("%d poses, %llu missed\n", count, missed);
    dds_delete(participant);
    return count >= wanted ? 0 : 1;
}
