// Takes the place of the C library's allocation functions, so that every library of the program
// comes by; hence a program of its own.
#include "counter.h"

#include <atomic>
#include <cerrno>
#include <cstddef>

// The C library's own ones, of which malloc and the others are aliases.
extern "C" void* __libc_malloc(std::size_t size);
extern "C" void* __libc_calloc(std::size_t count, std::size_t size);
extern "C" void* __libc_realloc(void* memory, std::size_t size);
extern "C" void* __libc_memalign(std::size_t alignment, std::size_t size);

namespace {

std::atomic<long> num_allocations{0};

}  // namespace

extern "C" {

void* malloc(std::size_t size) {
  ++num_allocations;
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) {
  ++num_allocations;
  return __libc_calloc(count, size);
}

void* realloc(void* memory, std::size_t size) {
  ++num_allocations;
  return __libc_realloc(memory, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++num_allocations;
  return __libc_memalign(alignment, size);
}

int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  ++num_allocations;
  *memory = __libc_memalign(alignment, size);
  return *memory == nullptr ? ENOMEM : 0;
}

}  // extern "C"

namespace vacuum_gripper_sim {

long CountAllocations() { return num_allocations; }

}  // namespace vacuum_gripper_sim
