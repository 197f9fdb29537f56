// The contact tests that a tick makes most often.
#include <benchmark/benchmark.h>

#include <trocar/collision/rods.hpp>
#include <trocar/core/random.hpp>

using namespace trocar;
using namespace trocar::collision;

namespace {

constexpr int kPairs = 1024;

std::vector<Capsule> rods(std::uint64_t seed, double length, double radius) {
  core::Random random(seed);
  std::vector<Capsule> made;
  for (int i = 0; i < kPairs; ++i) {
    const Vec3d a{random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02)};
    const Vec3d way{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    made.push_back({a, a + length * normalised(way), radius});
  }
  return made;
}

void RodTouchesRod(benchmark::State& state) {
  const std::vector<Capsule> shafts = rods(1, 0.14, 0.0025), elements = rods(2, 0.0025, 0.002);
  std::vector<Vec3f> side(kPairs);
  for (auto _ : state)
    for (size_t i = 0; i < size_t(kPairs); ++i) benchmark::DoNotOptimize(touch(shafts[i], elements[i], side[i]).depth);
  state.SetItemsProcessed(state.iterations() * kPairs);
}
BENCHMARK(RodTouchesRod);

void RodPushesSkin(benchmark::State& state) {
  const std::vector<Capsule> shafts = rods(1, 0.14, 0.0025), points = rods(3, 0.001, 0);
  for (auto _ : state)
    for (size_t i = 0; i < size_t(kPairs); ++i)
      benchmark::DoNotOptimize(push_out(shafts[i], points[i].a, {0, 0, 1}, 0.006).depth);
  state.SetItemsProcessed(state.iterations() * kPairs);
}
BENCHMARK(RodPushesSkin);

}  // namespace
