// One libFuzzer program per target (the build says which): TROCAR_FUZZ_TARGET is its name.
#include <cstdio>
#include <cstdlib>

#include "target.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t capacity);

namespace trocar::fuzz {

std::size_t plain_mutation(std::uint8_t* data, std::size_t size, std::size_t capacity) {
  return LLVMFuzzerMutate(data, size, capacity);
}

namespace {
const Target& target() {
  static const Target& t = *find(TROCAR_FUZZ_TARGET);
  return t;
}
}  // namespace

}  // namespace trocar::fuzz

using trocar::fuzz::target;

/// What a target makes once (a compiled scene) is not the first input's time.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  target().run({});
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    target().run({data, size});
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s: %s\n", TROCAR_FUZZ_TARGET, e.what());
    std::abort();
  }
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t capacity,
                                               unsigned seed) {
  return target().mutate ? target().mutate(data, size, capacity, seed) : LLVMFuzzerMutate(data, size, capacity);
}

extern "C" std::size_t LLVMFuzzerCustomCrossOver(const std::uint8_t* a, std::size_t a_size, const std::uint8_t* b,
                                                 std::size_t b_size, std::uint8_t* out, std::size_t capacity,
                                                 unsigned seed) {
  if (target().cross) return target().cross({a, a_size}, {b, b_size}, out, capacity, seed);
  const std::size_t head = a_size == 0 ? 0 : seed % (a_size + 1), tail = b_size == 0 ? 0 : (seed / 7) % (b_size + 1);
  std::size_t size = 0;
  for (std::size_t i = 0; i < head && size < capacity; ++i) out[size++] = a[i];
  for (std::size_t i = tail; i < b_size && size < capacity; ++i) out[size++] = b[i];
  return size;
}
