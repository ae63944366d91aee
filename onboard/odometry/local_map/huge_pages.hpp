// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <new>
#include <vector>

namespace cairn::odometry {

/// For large tables that are read at random. Linux translates addresses by pages of 4 kB. The processor remembers about
/// two thousand translations, 8 MB; beyond that a lookup waits for the translation, too. On pages of 2 MB it does not.
///
/// What has a megabyte or more begins on a boundary of 2 MB and asks for huge pages (madvise(2), MADV_HUGEPAGE). Where
/// the system has none, it is ordinary memory. Throws std::bad_alloc as operator new does.
template <class T>
struct HugePageAllocator {
  using value_type = T;
  HugePageAllocator() = default;
  /// Any two of them are alike, whatever they allocate.
  template <class U>
  explicit(false) HugePageAllocator(const HugePageAllocator<U>& /*any*/) noexcept {}
  friend bool operator==(const HugePageAllocator&, const HugePageAllocator&) { return true; }

  /// Memory for `n` elements, which are not made yet. To be given back with deallocate().
  [[nodiscard]] T* allocate(std::size_t n) {
    if (n > static_cast<std::size_t>(-1) / 2 / sizeof(T)) throw std::bad_array_new_length();
    const std::size_t bytes = n * sizeof(T);
    if (bytes < kSmallest) return static_cast<T*>(::operator new (bytes, std::align_val_t{alignof(T)}));
    const std::size_t whole_pages = (bytes + kPage - 1) / kPage * kPage;
    void* memory = ::operator new (whole_pages, std::align_val_t{kPage});
    ::madvise(memory, whole_pages, MADV_HUGEPAGE);  // a wish: without it the table works, only slower
    return static_cast<T*>(memory);
  }
  /// Gives back what allocate(n) gave, with the same `n`.
  void deallocate(T* memory, std::size_t n) noexcept {
    ::operator delete (memory, std::align_val_t{n * sizeof(T) < kSmallest ? alignof(T) : kPage});
  }

 private:
  static constexpr std::size_t kPage = std::size_t{2} << 20;
  static constexpr std::size_t kSmallest = kPage / 2;
};

/// A vector whose elements lie on huge pages.
template <class T>
using HugePageVector = std::vector<T, HugePageAllocator<T>>;

}  // namespace cairn::odometry
