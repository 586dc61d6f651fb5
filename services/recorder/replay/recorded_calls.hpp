// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>

#include "services/common/request_id.hpp"
#include "tracker_requests.h"

namespace pursuit::recorder {

/// A call that would change the tracker, and what the tracker answered.
struct RecordedCall {
    v1::TrackerRequest request;
    v1::TrackerReply reply;
    std::size_t stream = 0;  ///< In which the reply was heard.
    std::size_t order = 0;   ///< Of the reply among all, from 1.
};

/// Brings the requests and replies of a recording together. They come on two topics: nothing keeps
/// the recorder from hearing the reply first.
///
///   nothing ─► request or reply heard ─► both heard: the call is given, once
///
/// Threads: one. At most most_planned_calls are remembered; the later ones are left out.
class RecordedCalls {
 public:
    /// The call, where its other half was heard before. What only asks, or was sent again, gives
    /// nothing.
    std::optional<RecordedCall> take(v1::TrackerRequest request);
    std::optional<RecordedCall> take(v1::TrackerReply reply, std::size_t stream);

    /// Requests whose reply was not heard.
    std::uint64_t unanswered() const;
    /// Calls that the tracker obeyed, of which the reply alone was heard.
    std::uint64_t unasked() const;

    /// Whether some were left out.
    bool too_many() const { return too_many_; }

 private:
    struct Exchange {
        std::optional<v1::TrackerRequest> request;
        std::optional<v1::TrackerReply> reply;
        std::size_t stream = 0;
        std::size_t order = 0;
        bool given = false;
    };

    Exchange* exchange(const v1::RequestId& id);
    static std::optional<RecordedCall> give(Exchange& exchange);

    std::map<RequestKey, Exchange> exchanges_;
    std::size_t replies_ = 0;
    bool too_many_ = false;
};

}  // namespace pursuit::recorder
