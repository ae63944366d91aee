// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/failing_malloc.hpp"

#include <cstdlib>
#include <new>

namespace {

thread_local long countdown = -1;
thread_local bool failed = false;

void* allocate(std::size_t size) noexcept {
  if (countdown >= 0 && countdown-- == 0) {
    failed = true;
    return nullptr;
  }
  return std::malloc(size == 0 ? 1 : size);
}

}  // namespace

void* operator new(std::size_t size) {
  if (void* memory = allocate(size)) return memory;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return allocate(size); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace cairn::faults {

void fail_allocation(long n) {
  countdown = n;
  failed = false;
}
bool allocation_failed() { return failed; }

}  // namespace cairn::faults
