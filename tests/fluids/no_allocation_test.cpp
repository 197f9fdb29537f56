// The step's law: no allocation. Every operator new of this program counts.
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>

#include "plates.hpp"

namespace {
std::atomic<long> g_allocations{0};
void* counted(std::size_t size, std::size_t alignment) {
  ++g_allocations;
  const std::size_t rounded = (size + alignment - 1) / alignment * alignment;
  void* p = std::aligned_alloc(alignment, rounded ? rounded : alignment);
  if (!p) throw std::bad_alloc();
  return p;
}
}  // namespace

void* operator new(std::size_t size) { return counted(size, alignof(std::max_align_t)); }
void* operator new(std::size_t size, std::align_val_t alignment) { return counted(size, std::size_t(alignment)); }
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete(void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }

namespace trocar::fluids {
namespace {

TEST(NoAllocation, InATickOfAllFluids) {
  test::Scene b(test::small_scene());
  b.plates = {{.centre = {0, 0, 0.04f}, .normal = {0.6f, 0, 0.8f}, .radius = 0.02f, .first_film = 0, .film_cells = 5}};
  b.openings = {test::bleeding({0, 0, 0.07f}, {0.6f, 0, 0.8f}, 3e-5, 2e-6)};
  b.tools = {{.tip = {0.02f, 0, 0.01f}, .irrigation = 1, .suction = 1}};
  b.capsules = {{.a = {0, 0, 0}, .b = {0.05f, 0, 0.1f}, .radius = 0.004f, .body = 9}};
  b.boiled = {{{0, 0, 0.03}, 1e-8}};
  const long before = g_allocations;
  for (int t = 0; t < 600; ++t) b.tick();
  EXPECT_EQ(g_allocations, before);
  EXPECT_GT(b.s.droplets.count, 50);
  EXPECT_GT(b.millilitres(Place::kPool), 1);
}

}  // namespace
}  // namespace trocar::fluids
