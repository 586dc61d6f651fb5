// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>

namespace pursuit::tracker {

/// A table of many megabytes that is looked into anywhere: in huge pages where the system has them,
/// because the processor remembers the places of some thousand pages only.
template <class T>
class LargeTable {
 public:
    /// Throws std::bad_alloc.
    void assign(std::size_t count, const T& value) {
        if (count != count_) {
            const std::size_t bytes = (count * sizeof(T) / page_bytes + 1) * page_bytes;
            table_.reset(static_cast<T*>(std::aligned_alloc(page_bytes, bytes)));
            count_ = table_ ? count : 0;
            if (!table_) throw std::bad_alloc();
            static_cast<void>(madvise(table_.get(), bytes, MADV_HUGEPAGE));
        }
        std::uninitialized_fill_n(table_.get(), count, value);
    }

    [[nodiscard]] std::size_t size() const { return count_; }
    T& operator[](std::size_t i) { return table_.get()[i]; }
    const T& operator[](std::size_t i) const { return table_.get()[i]; }

 private:
    static constexpr std::size_t page_bytes = std::size_t{1} << 21;
    static_assert(std::is_trivially_destructible_v<T>);

    struct Free {
        void operator()(T* table) const { std::free(table); }
    };
    std::unique_ptr<T, Free> table_;
    std::size_t count_ = 0;
};

}  // namespace pursuit::tracker
