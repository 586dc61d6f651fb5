// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <functional>
#include <random>
#include <vector>

namespace pursuit::testing {

using Bytes = std::vector<unsigned char>;

/// A type that is nothing but its bytes.
class RawType : public eprosima::fastdds::dds::TopicDataType {
 public:
    explicit RawType(const char* name, bool is_keyed = false) {
        setName(name);
        m_typeSize = 70000;
        m_isGetKeyDefined = is_keyed;
        auto_fill_type_information(false);
        auto_fill_type_object(false);
    }
    bool serialize(void* data, eprosima::fastrtps::rtps::SerializedPayload_t* payload) override {
        const auto& bytes = *static_cast<Bytes*>(data);
        std::memcpy(payload->data, bytes.data(), bytes.size());
        payload->length = static_cast<std::uint32_t>(bytes.size());
        return true;
    }
    bool deserialize(eprosima::fastrtps::rtps::SerializedPayload_t*, void*) override {
        return false;
    }
    std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
        return [data] { return static_cast<std::uint32_t>(static_cast<Bytes*>(data)->size()); };
    }
    void* createData() override { return new Bytes; }
    void deleteData(void* data) override { delete static_cast<Bytes*>(data); }
    bool getKey(void*, eprosima::fastrtps::rtps::InstanceHandle_t* handle, bool) override {
        handle->value[0] = 1;
        return m_isGetKeyDefined;
    }
};

/// Samples that none of our types is made of.
inline std::vector<Bytes> malformed_samples() {
    std::vector<Bytes> samples{
        {0, 1, 0},                             // shorter than the encapsulation
        {0, 1, 0, 0},                          // nothing behind it
        {0, 1, 0, 0, 1},                       // cut within the first field
        {0, 7, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8},  // an encapsulation that is not plain CDR
        Bytes(64, 0xff),
    };
    std::mt19937 random(1);
    for (int i = 0; i < 20; ++i) {
        Bytes bytes(8 + random() % 200);
        for (auto& byte : bytes) byte = static_cast<unsigned char>(0x80 | random());
        bytes[0] = 0;
        bytes[1] = static_cast<unsigned char>(2 + random() % 250);  // never a known encapsulation
        samples.push_back(bytes);
    }
    return samples;
}

}  // namespace pursuit::testing
