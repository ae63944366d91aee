// SPDX-License-Identifier: Apache-2.0
// Stands between the program and the C library. Not for builds with a sanitiser, which stands there itself.
#include "tests/faults/forbidden_calls.hpp"

#include <dlfcn.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <cstdlib>
#include <cstring>
#include <initializer_list>

// glibc's own allocator, under names that are not reserved to it.
extern "C" {
void* libc_malloc(std::size_t size) __asm__("__libc_malloc");
void* libc_calloc(std::size_t n, std::size_t size) __asm__("__libc_calloc");
void* libc_realloc(void* memory, std::size_t size) __asm__("__libc_realloc");
void* libc_memalign(std::size_t alignment, std::size_t size) __asm__("__libc_memalign");
}

namespace {

thread_local bool forbidden = false;
thread_local long seen = 0;

void called(const char* name) {
  ++seen;
  if (!forbidden) return;
  forbidden = false;
  for (const char* text : {"forbidden call: ", name, "\n"}) (void)!::write(STDERR_FILENO, text, std::strlen(text));
  std::abort();
}

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

}  // namespace

namespace cairn::faults {

void forbid_calls() { forbidden = true; }
void allow_calls() { forbidden = false; }
long calls_seen() { return seen; }

}  // namespace cairn::faults

extern "C" {

void* malloc(std::size_t size) {
  called("malloc");
  return libc_malloc(size);
}
void* calloc(std::size_t n, std::size_t size) {
  called("calloc");
  return libc_calloc(n, size);
}
void* realloc(void* memory, std::size_t size) {
  called("realloc");
  return libc_realloc(memory, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  called("aligned_alloc");
  return libc_memalign(alignment, size);
}
int posix_memalign(void** out, std::size_t alignment, std::size_t size) {
  called("posix_memalign");
  *out = libc_memalign(alignment, size);
  return *out != nullptr ? 0 : ENOMEM;
}

int pthread_mutex_lock(pthread_mutex_t* mutex) {
  static const auto original = next<int(pthread_mutex_t*)>("pthread_mutex_lock");
  called("pthread_mutex_lock");
  return original(mutex);
}
int pthread_rwlock_rdlock(pthread_rwlock_t* lock) {
  static const auto original = next<int(pthread_rwlock_t*)>("pthread_rwlock_rdlock");
  called("pthread_rwlock_rdlock");
  return original(lock);
}
int pthread_rwlock_wrlock(pthread_rwlock_t* lock) {
  static const auto original = next<int(pthread_rwlock_t*)>("pthread_rwlock_wrlock");
  called("pthread_rwlock_wrlock");
  return original(lock);
}
int pthread_cond_wait(pthread_cond_t* condition, pthread_mutex_t* mutex) {
  static const auto original = next<int(pthread_cond_t*, pthread_mutex_t*)>("pthread_cond_wait");
  called("pthread_cond_wait");
  return original(condition, mutex);
}
int sem_wait(sem_t* semaphore) {
  static const auto original = next<int(sem_t*)>("sem_wait");
  called("sem_wait");
  return original(semaphore);
}
/// std::atomic waits and wakes through it.
long syscall(long number, ...) {
  static const auto original = next<long(long, ...)>("syscall");
  std::va_list list;
  va_start(list, number);
  long a[6];
  for (long& value : a) value = va_arg(list, long);
  va_end(list);
  if (number == SYS_futex) called("futex");
  return original(number, a[0], a[1], a[2], a[3], a[4], a[5]);
}
}
