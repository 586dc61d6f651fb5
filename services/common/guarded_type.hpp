// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <set>

#include "services/common/topics.hpp"

namespace pursuit {

/// A generated type support that survives what comes from the network. The generated code lets
/// exceptions of a malformed sample escape into the middleware's receiving thread, which ends the
/// process; here such a sample is refused and counted. Threads: as the generated type.
///
/// A sample of a keyed topic is deserialized twice: by the middleware, which looks for its key in
/// an object of its own (made by createData()), and by who takes it. Only the second is counted.
template <class T>
class GuardedType : public Wire<T>::Support {
 public:
    explicit GuardedType(std::shared_ptr<std::atomic<std::uint64_t>> malformed)
        : malformed_(std::move(malformed)) {
        // Announced type objects stop other vendors' participants from matching.
        this->auto_fill_type_information(false);
        this->auto_fill_type_object(false);
    }

    bool deserialize(eprosima::fastrtps::rtps::SerializedPayload_t* payload, void* data) override {
        // Encapsulation {0,0} is big-endian, {0,1} little-endian plain CDR; nothing else is ours.
        bool good = payload->length >= 4 && payload->data[0] == 0 && payload->data[1] <= 1;
        if (good) {
            try {
                good = Wire<T>::Support::deserialize(payload, data) &&
                       Wire<T>::in_bounds(*static_cast<T*>(data));
            } catch (...) {  // whatever it was, the sample is refused and counted below
                good = false;
            }
        }
        if (!good && !is_own(data)) malformed_->fetch_add(1, std::memory_order_relaxed);
        return good;
    }

    void* createData() override {
        void* data = Wire<T>::Support::createData();
        const std::scoped_lock lock(mutex_);
        own_.insert(data);
        return data;
    }
    void deleteData(void* data) override {
        {
            const std::scoped_lock lock(mutex_);
            own_.erase(data);
        }
        Wire<T>::Support::deleteData(data);
    }

 private:
    bool is_own(void* data) const {
        const std::scoped_lock lock(mutex_);
        return own_.contains(data);
    }

    mutable std::mutex mutex_;
    std::set<void*> own_;
    std::shared_ptr<std::atomic<std::uint64_t>> malformed_;
};

}  // namespace pursuit
