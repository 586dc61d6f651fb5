// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>

namespace pursuit::tracker {

/// A table of many megabytes that is looked into anywhere, all zero to begin with: in huge pages
/// where the system has them, because the processor remembers the places of some thousand pages
/// only. Each page is cleared when it is first touched, so that a stream does not wait for all of
/// them to be cleared at its beginning.
template <class T>
class LargeTable {
    static_assert(std::is_trivial_v<T>);

 public:
    /// All zero again, with so many entries. Throws std::bad_alloc.
    void restart(std::size_t count) {
        if (count == count_ && memory_ && memory_->forget()) return;
        memory_.reset();
        count_ = 0;
        table_ = nullptr;
        memory_ = std::make_unique<Memory>(count * sizeof(T));
        table_ = static_cast<T*>(memory_->begin());
        count_ = count;
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
        /// All of it is zero again; false where the system would not.
        [[nodiscard]] bool forget() { return ::madvise(begin_, bytes_, MADV_DONTNEED) == 0; }

     private:
        std::size_t bytes_;
        std::size_t mapped_bytes_;
        void* mapped_ = nullptr;
        void* begin_ = nullptr;
    };

    static constexpr std::size_t page_bytes = std::size_t{1} << 21;

    std::unique_ptr<Memory> memory_;
    T* table_ = nullptr;
    std::size_t count_ = 0;
};

}  // namespace pursuit::tracker
