// SPDX-License-Identifier: Apache-2.0
#include "services/common/csv.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <limits>
#include <random>

#include "tests/support/temporary_folder.hpp"

namespace pursuit {
namespace {

using testing::HasSubstr;

TEST(CsvReader, finds_columns_by_name_and_rows_between_remarks) {
    const test::TemporaryFolder folder;
    auto table = CsvReader::open(folder.file("t.csv", "# r\n\na , b\r\n 1 ,x\n#\n\n-2.5,\n3\n"));
    ASSERT_TRUE(table);
    EXPECT_EQ(table->column("b"), 1U);
    EXPECT_FALSE(table->column("c"));
    ASSERT_TRUE(*table->next());
    EXPECT_EQ(*table->number<int>(0), 1);
    EXPECT_EQ(table->field(1), "x");
    ASSERT_TRUE(*table->next());
    EXPECT_EQ(*table->number<double>(0), -2.5);
    EXPECT_EQ(table->field(1), "");
    ASSERT_TRUE(*table->next());
    EXPECT_EQ(table->field(1), "");
    EXPECT_THAT(table->where(), HasSubstr("t.csv:8"));
    EXPECT_FALSE(*table->next());
    EXPECT_FALSE(*table->next());
}

TEST(CsvReader, reads_a_last_line_without_its_end) {
    const test::TemporaryFolder folder;
    auto table = CsvReader::open(folder.file("t.csv", "a\n1\n2"));
    ASSERT_TRUE(*table->next());
    ASSERT_TRUE(*table->next());
    EXPECT_EQ(table->field(0), "2");
    EXPECT_FALSE(*table->next());
}

TEST(CsvReader, names_line_and_column_of_what_is_no_number_of_its_kind) {
    const test::TemporaryFolder folder;
    auto table = CsvReader::open(folder.file("t.csv", "a,b\n1.5,\n"));
    ASSERT_TRUE(*table->next());
    EXPECT_THAT(table->number<int>(0).error().message,
                HasSubstr("t.csv:2: column a: \"1.5\" is not a number of its kind"));
    EXPECT_FALSE(table->number<double>(1));
    EXPECT_FALSE(table->number<std::uint8_t>(7));
}

TEST(CsvReader, names_the_column_before_which_a_row_ends) {
    const test::TemporaryFolder folder;
    auto table = CsvReader::open(folder.file("t.csv", "a,b,c\n1,2,\n1,2\n"));
    ASSERT_TRUE(*table->next());
    EXPECT_TRUE(table->check_length());
    ASSERT_TRUE(*table->next());
    EXPECT_THAT(table->check_length().error().message,
                HasSubstr("t.csv:3: the row ends before column c"));
}

TEST(AppendNumber, gives_text_that_reads_back_as_the_same_bits) {
    std::mt19937_64 random(1);
    for (int i = 0; i < 10'000; ++i) {
        const auto value = std::bit_cast<double>(random());
        if (value != value) continue;
        std::string text;
        append_number(text, value);
        double read = 0;
        std::from_chars(text.data(), text.data() + text.size(), read);
        EXPECT_EQ(std::bit_cast<std::uint64_t>(read), std::bit_cast<std::uint64_t>(value)) << text;
    }
    std::string text;
    append_number(text, std::numeric_limits<double>::quiet_NaN());
    EXPECT_EQ(text, "nan");
}

}  // namespace
}  // namespace pursuit
