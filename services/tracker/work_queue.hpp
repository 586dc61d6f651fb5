// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

namespace pursuit::tracker {

/// How full a WorkQueue is, packets.
struct QueueFigures {
    std::size_t packets = 0;
    std::size_t packets_max = 0;  ///< The most since the start.
    std::size_t capacity = 0;
};

/// What waits for the core thread, packets and requests in the order they came.
///
/// At the limit of packets the oldest one makes room for the newest and is handed back to be
/// counted: under overload poses stay young. Requests are bounded on their own and are never
/// dropped: one too many is refused to its sender.
/// Threads: any; nothing blocks but pop().
template <class Packet, class Request>
class WorkQueue {
 public:
    using Work = std::variant<Packet, Request>;

    WorkQueue(std::size_t packets, std::size_t requests)
        : packet_capacity_(packets), request_capacity_(requests) {}

    /// The packet that had to make room, if one had to.
    std::optional<Packet> push_packet(Packet packet) {
        std::optional<Packet> dropped;
        {
            const std::scoped_lock lock(mutex_);
            if (packets_.size() >= packet_capacity_) {
                dropped = std::move(packets_.front().content);
                packets_.pop_front();
            }
            packets_.push_back({++arrivals_, std::move(packet)});
            packets_max_ = std::max(packets_max_, packets_.size());
        }
        changed_.notify_one();
        return dropped;
    }

    /// False, and `request` untouched, when too many wait.
    [[nodiscard]] bool push_request(Request& request) {
        {
            const std::scoped_lock lock(mutex_);
            if (requests_.size() >= request_capacity_) return false;
            requests_.push_back({++arrivals_, std::move(request)});
        }
        changed_.notify_one();
        return true;
    }

    /// Waits for the next piece of work; nothing after wake() or close().
    std::optional<Work> pop() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock,
                      [&] { return closed_ || woken_ || !packets_.empty() || !requests_.empty(); });
        if (closed_ || std::exchange(woken_, false)) return std::nullopt;
        const bool is_request =
            !requests_.empty() &&
            (packets_.empty() || requests_.front().arrival < packets_.front().arrival);
        std::optional<Work> work;
        if (is_request) {
            work.emplace(std::in_place_index<1>, std::move(requests_.front().content));
            requests_.pop_front();
        } else {
            work.emplace(std::in_place_index<0>, std::move(packets_.front().content));
            packets_.pop_front();
        }
        return work;
    }

    /// Lets pop() return once without work.
    void wake() {
        {
            const std::scoped_lock lock(mutex_);
            woken_ = true;
        }
        changed_.notify_one();
    }

    /// What still waits is left for rest(); pop() returns nothing from now on.
    void close() {
        {
            const std::scoped_lock lock(mutex_);
            closed_ = true;
        }
        changed_.notify_one();
    }

    /// What waited when the queue was closed: the packets, then the requests, in order.
    std::vector<Work> rest() {
        const std::scoped_lock lock(mutex_);
        std::vector<Work> rest;
        for (auto& packet : packets_) {
            rest.emplace_back(std::in_place_index<0>, std::move(packet.content));
        }
        for (auto& request : requests_) {
            rest.emplace_back(std::in_place_index<1>, std::move(request.content));
        }
        packets_.clear();
        requests_.clear();
        return rest;
    }

    [[nodiscard]] bool closed() const {
        const std::scoped_lock lock(mutex_);
        return closed_;
    }

    [[nodiscard]] QueueFigures figures() const {
        const std::scoped_lock lock(mutex_);
        return {packets_.size(), packets_max_, packet_capacity_};
    }

 private:
    template <class Content>
    struct Waiting {
        std::uint64_t arrival;
        Content content;
    };

    const std::size_t packet_capacity_;
    const std::size_t request_capacity_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Waiting<Packet>> packets_;
    std::deque<Waiting<Request>> requests_;
    std::uint64_t arrivals_ = 0;
    std::size_t packets_max_ = 0;
    bool woken_ = false;
    bool closed_ = false;
};

}  // namespace pursuit::tracker
