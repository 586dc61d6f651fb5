// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "status.h"

namespace pursuit {

/// Into the causes of a status: what a RequestServer did not take and could not send. The callers
/// hear nothing of it.
template <class Server>
void add_losses(std::vector<v1::NamedCount>& causes, const Server& server) {
    const auto add = [&](const char* name, std::uint64_t count) {
        v1::NamedCount cause;
        cause.name(name);
        cause.count(count);
        causes.push_back(cause);
    };
    add("requests.not_taken", server.overflows());
    add("writes.replies_failed", server.failures());
}

}  // namespace pursuit
