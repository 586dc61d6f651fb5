// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/mman.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>

namespace pursuit::tracker {

/// A table of many megabytes that is looked into anywhere, all zero to begin with: in huge pages
/// where the system has them, because the processor remembers the places of some thousand pages
/// only. It takes the system up to some ms to hand over each of them: those that were reserved are
/// there before they are needed.
template <class T>
class LargeTable {
    static_assert(std::is_trivial_v<T>);

 public:
    /// Room for so many entries is there from now on. Throws std::bad_alloc, and then it has none.
    void reserve(std::size_t count) {
        if (count <= room_) return;
        map(count);
        used_ = room_;
        restart(0);
    }

    /// All zero again, with so many entries. Throws std::bad_alloc, and then it has none.
    void restart(std::size_t count) {
        if (count > room_) map(count);
        std::fill_n(table_, used_, T{});
        used_ = count_ = count;
    }

    [[nodiscard]] std::size_t size() const { return count_; }
    T& operator[](std::size_t i) { return table_[i]; }
    const T& operator[](std::size_t i) const { return table_[i]; }

 private:
    /// Whole huge pages of the system's memory.
    class Memory {
     public:
        explicit Memory(std::size_t bytes)
            : bytes_((bytes / page_bytes + 1) * page_bytes), mapped_bytes_(bytes_ + page_bytes) {
            mapped_ = ::mmap(nullptr, mapped_bytes_, PROT_READ | PROT_WRITE,
                             MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
            if (mapped_ == MAP_FAILED) throw std::bad_alloc();
            begin_ = mapped_;
            std::size_t room = mapped_bytes_;
            std::align(page_bytes, bytes_, begin_, room);
            // Without huge pages it is slower, and as good otherwise.
            static_cast<void>(::madvise(begin_, bytes_, MADV_HUGEPAGE));
        }
        ~Memory() { ::munmap(mapped_, mapped_bytes_); }
        Memory(const Memory&) = delete;
        Memory& operator=(const Memory&) = delete;

        [[nodiscard]] void* begin() const { return begin_; }
        [[nodiscard]] std::size_t size() const { return bytes_; }

     private:
        std::size_t bytes_;
        std::size_t mapped_bytes_;
        void* mapped_ = nullptr;
        void* begin_ = nullptr;
    };

    // All zero, as the system gives it.
    void map(std::size_t count) {
        memory_.reset();
        table_ = nullptr;
        room_ = used_ = count_ = 0;
        memory_ = std::make_unique<Memory>(count * sizeof(T));
        table_ = static_cast<T*>(memory_->begin());
        room_ = memory_->size() / sizeof(T);
    }

    static constexpr std::size_t page_bytes = std::size_t{1} << 21;

    std::unique_ptr<Memory> memory_;
    T* table_ = nullptr;
    std::size_t room_ = 0;  // entries
    std::size_t used_ = 0;  // the first of them that may not be zero
    std::size_t count_ = 0;
};

}  // namespace pursuit::tracker
