// SPDX-License-Identifier: Apache-2.0
#include "services/common/request_losses.hpp"

#include <gtest/gtest.h>

namespace pursuit {
namespace {

struct Server {
    static std::uint64_t overflows() { return 3; }
    static std::uint64_t failures() { return 4; }
};

TEST(RequestLosses, are_named_behind_the_causes_that_are_there) {
    std::vector<v1::NamedCount> causes(1);
    add_losses(causes, Server{});
    ASSERT_EQ(causes.size(), 3U);
    EXPECT_EQ(causes[1].name().to_string(), "requests.not_taken");
    EXPECT_EQ(causes[1].count(), 3U);
    EXPECT_EQ(causes[2].name().to_string(), "writes.replies_failed");
    EXPECT_EQ(causes[2].count(), 4U);
}

}  // namespace
}  // namespace pursuit
