// What a period of a haptic device costs beside waiting: the god object, a whole force, messages of devices.
#include <benchmark/benchmark.h>

#include <trocar/core/random.hpp>
#include <trocar/devices/haptics/force_renderer.hpp>
#include <trocar/devices/haptics/haply_messages.hpp>
#include <trocar/devices/haptics/seam_protocol.hpp>
#include <trocar/devices/haptics/simulated_device.hpp>

using namespace trocar;
using namespace trocar::devices;

namespace {

LocalModel corner(int planes) {
  LocalModel m;
  m.plane[0] = {{0, 0, 0}, {0, 0, 1}};
  m.plane[1] = {{0, 0, 0}, normalised(Vec3d{1, 0, 0.3})};
  m.plane[2] = {{0, 0, 0}, normalised(Vec3d{-0.2, 1, 0.1})};
  m.planes = planes;
  m.stiffness = 500;
  m.rubbing = 0.1;
  m.port = {0, 0, 0.2};
  m.seal_friction = 0.5;
  m.holds = 1;
  m.held_stiffness = 100;
  return m;
}

std::vector<Vec3d> places() {
  core::Random random(1);
  std::vector<Vec3d> out;
  for (int i = 0; i < 1024; ++i)
    out.push_back({random.uniform(-0.01, 0.01), random.uniform(-0.01, 0.01), random.uniform(-0.01, 0.01)});
  return out;
}

void GodObject(benchmark::State& state) {
  const LocalModel m = corner(int(state.range(0)));
  const std::vector<Vec3d> p = places();
  const std::span<const ContactPlane> planes(m.plane, std::size_t(m.planes));
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(nearest_allowed(p[i++ % p.size()], planes));
}
BENCHMARK(GodObject)->Arg(1)->Arg(2)->Arg(3);

void Force(benchmark::State& state) {
  const SimulatedDevice device;
  ForceRenderer renderer(device.capabilities(), {});
  const LocalModel m = corner(3);
  const std::vector<Vec3d> p = places();
  HapticSample sample;
  std::size_t i = 0;
  for (auto _ : state) {
    sample.position = p[i++ % p.size()];
    benchmark::DoNotOptimize(renderer.force(sample, m, 0));
  }
}
BENCHMARK(Force);

void HaplyMessage(benchmark::State& state) {
  const std::string text =
      R"({"inverse3":[{"device_id":"049D","state":{"cursor_position":{"x":0.01,"y":-0.12,"z":0.15},)"
      R"("cursor_velocity":{"x":0,"y":0,"z":0},"angular_position":{"a0":0,"a1":0,"a2":0}},"status":{"ready":true}}]})";
  for (auto _ : state) benchmark::DoNotOptimize(read_haply(text));
}
BENCHMARK(HaplyMessage);

void SeamSample(benchmark::State& state) {
  std::array<std::uint8_t, kSampleBytes> bytes;
  write_sample(bytes, {});
  for (auto _ : state) benchmark::DoNotOptimize(read_sample(bytes));
}
BENCHMARK(SeamSample);

}  // namespace
