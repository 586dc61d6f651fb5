// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fastdds/rtps/common/SerializedPayload.h>
#include <algorithm>
#include <cstdint>
#include <vector>

#include "services/common/topics.hpp"

namespace pursuit::recorder {

/// A sample as a raw type gives and takes it: serialized, encapsulation header included.
using Payload = std::vector<std::uint8_t>;

/// A type support that copies the serialized payload and looks into it only where a key is needed
/// and the writer did not send the key's hash. To its peers it is the generated type. Threads: as
/// the generated type.
template <class T>
class RawType : public eprosima::fastdds::dds::TopicDataType {
    using SerializedPayload = eprosima::fastrtps::rtps::SerializedPayload_t;
    using InstanceHandle = eprosima::fastrtps::rtps::InstanceHandle_t;

 public:
    RawType() {
        setName(generated_.getName());
        m_typeSize = generated_.m_typeSize;
        m_isGetKeyDefined = generated_.m_isGetKeyDefined;
        // Announced type objects stop other vendors' participants from matching.
        auto_fill_type_information(false);
        auto_fill_type_object(false);
    }

    bool serialize(void* data, SerializedPayload* to) override {
        const auto& payload = *static_cast<const Payload*>(data);
        if (payload.size() < 4 || payload.size() > to->max_size) return false;
        std::copy(payload.begin(), payload.end(), to->data);
        to->length = static_cast<std::uint32_t>(payload.size());
        to->encapsulation = payload[1];
        return true;
    }
    bool deserialize(SerializedPayload* from, void* data) override {
        static_cast<Payload*>(data)->assign(from->data, from->data + from->length);
        return true;
    }
    std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
        return [data] {
            return static_cast<std::uint32_t>(static_cast<const Payload*>(data)->size());
        };
    }
    void* createData() override { return new Payload; }
    void deleteData(void* data) override { delete static_cast<Payload*>(data); }

    bool getKey(void* data, InstanceHandle* handle, bool force_md5) override {
        if (!m_isGetKeyDefined) return false;
        auto& payload = *static_cast<Payload*>(data);
        if (payload.size() < 4 || payload[0] != 0 || payload[1] > 1) return false;
        SerializedPayload view;
        view.data = payload.data();
        view.length = view.max_size = static_cast<std::uint32_t>(payload.size());
        bool good = false;
        try {
            T sample;
            good = generated_.deserialize(&view, &sample) &&
                   generated_.getKey(&sample, handle, force_md5);
        } catch (...) {  // a malformed sample has no key
        }
        view.data = nullptr;  // not its own
        return good;
    }

 private:
    typename Wire<T>::Support generated_;
};

}  // namespace pursuit::recorder
