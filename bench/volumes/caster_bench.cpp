// The ray caster on a block of 256^3: a trunk of soft tissue with noise, a spine and ribs of bone, vessels and lungs,
// seen from half in front so that it fills the picture's height. Run it alone: volumes_bench --benchmark_filter=Cast
// With TROCAR_CASTER_FILES=FOLDER what is cast is written there as well, for tools/volume_peers.py: block.nrrd, the
// looks' points in looks.json, and what was drawn as bone_still.ppm and so on.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <thread>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <trocar/core/parallel.hpp>
#include <trocar/core/random.hpp>
#include <trocar/volumes/files/volume_writer.hpp>
#include <trocar/volumes/show/caster.hpp>
#include <trocar/volumes/show/slice_image.hpp>

namespace trocar::volumes {
namespace {

constexpr int kSize = 256;

double trunk(Vec3d p) {  // [mm]; x left, y back, z head
  const double body = std::hypot(p.x / 118, p.y / 88);
  if (body > 1) return -1000;
  if (body > 0.94) return -90;
  const double rib = std::fabs(std::remainder(p.z + 0.35 * std::fabs(p.x), 26.0));
  if (body > 0.84 && body < 0.9 && rib < 6) return 650 - 60 * rib;
  if (std::hypot(p.x, p.y - 62) < 17 && std::fabs(std::remainder(p.z, 32.0)) < 13) return 520;
  for (const double side : {-1.0, 1.0})
    if (std::hypot(p.x - side * 55, p.y, 0.6 * (p.z - 60)) < 42) return -820;
  if (std::hypot(p.x - 8 - 5 * std::sin(p.z / 20), p.y - 35) < 9) return 260;
  return 45;
}

const Volume& block() {
  static const Volume volume = [] {
    Volume v;
    v.grid.size = {kSize, kSize, kSize};
    v.grid.origin = {-127.5, -127.5, -127.5};
    v.stored.resize(v.grid.count());
    core::Random random(1);
    for (std::size_t i = 0; i < v.stored.size(); ++i) {
      const Index3 at = v.grid.place(i);
      const double value = trunk(v.grid.to_patient({double(at[0]), double(at[1]), double(at[2])}));
      v.stored[i] = v.number_of(value + (value > -1000 ? 24 * (random.uniform() - 0.5) : 0));
    }
    return v;
  }();
  return volume;
}

const View kView{{0.25, 0.15, 0.5}, {}, {0, 1, 0}, 30, 0, 640, 480};

constexpr TransferPreset kPresets[] = {TransferPreset::bone, TransferPreset::skin, TransferPreset::vessels,
                                       TransferPreset::soft_tissue};
const char* name_of_preset(TransferPreset p) {
  constexpr const char* kNames[] = {"bone", "skin", "vessels", "soft_tissue"};
  return kNames[std::size_t(p)];
}

/// {"bone": [[value, red, green, blue, opacity], ...], ...}
std::string looks_as_json() {
  std::string out;
  for (const TransferPreset preset : kPresets) {
    std::string points;
    for (const TransferPoint& p : transfer_preset(preset).points)
      points += fmt::format("{}[{}, {}, {}, {}, {}]", points.empty() ? "" : ", ", p.value, p.colour[0], p.colour[1],
                            p.colour[2], p.opacity);
    out += fmt::format("{}\"{}\": [{}]", out.empty() ? "{" : ",\n ", name_of_preset(preset), points);
  }
  return out + "}\n";
}

std::string as_ppm(const Picture& picture) {
  std::string out = fmt::format("P6\n{} {}\n255\n", picture.width, picture.height);
  for (std::size_t i = 0; i < picture.rgba.size(); ++i)
    if (i % 4 != 3) out += char(picture.rgba[i]);
  return out;
}

void write_bytes(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

void write_for_peers(TransferPreset preset, bool moving, const Picture& picture) {
  const char* folder = std::getenv("TROCAR_CASTER_FILES");
  if (!folder) return;
  const std::filesystem::path path = folder;
  static const bool once = [&] {
    write_bytes(path / "block.nrrd", to_nrrd(block(), false));
    write_bytes(path / "looks.json", looks_as_json());
    return true;
  }();
  if (once)
    write_bytes(path / fmt::format("{}_{}.ppm", name_of_preset(preset), moving ? "moving" : "still"), as_ppm(picture));
}

void cast(benchmark::State& state, bool moving) {
  const TransferPreset preset = kPresets[state.range(0)];
  state.SetLabel(name_of_preset(preset));
  const Quality quality = moving ? moving_quality() : Quality{};
  core::ThreadPool pool(int(std::max(1u, std::thread::hardware_concurrency())));
  VolumeCaster caster(block(), pool);
  caster.set_transfer(transfer_preset(preset));
  const std::clock_t begin = std::clock();
  for (auto _ : state) benchmark::DoNotOptimize(caster.render(kView, quality).picture.rgba.data());
  const double ms = 1e3 * double(std::clock() - begin) / CLOCKS_PER_SEC;
  state.counters["images/s"] = benchmark::Counter(double(state.iterations()), benchmark::Counter::kIsRate);
  state.counters["all_threads_ms"] = ms / double(state.iterations());  // of the processor
  write_for_peers(preset, moving, caster.render(kView, quality).picture);
}

void BM_CastStill(benchmark::State& state) { cast(state, false); }
void BM_CastMoving(benchmark::State& state) { cast(state, true); }
BENCHMARK(BM_CastStill)->DenseRange(0, 3)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(BM_CastMoving)->DenseRange(0, 3)->Unit(benchmark::kMillisecond)->UseRealTime();

/// An edit of the transfer function: the empty cells are found anew.
void BM_ChangeTransfer(benchmark::State& state) {
  core::ThreadPool pool(2);
  VolumeCaster caster(block(), pool);
  for (auto _ : state) caster.set_transfer(transfer_preset(TransferPreset::bone));
}
BENCHMARK(BM_ChangeTransfer)->Unit(benchmark::kMillisecond);

void BM_CellsOfAVolume(benchmark::State& state) {
  core::ThreadPool pool(2);
  block();
  for (auto _ : state) benchmark::DoNotOptimize(VolumeCaster(block(), pool));
}
BENCHMARK(BM_CellsOfAVolume)->Unit(benchmark::kMillisecond)->UseRealTime();

void BM_AxialSlice(benchmark::State& state) {
  const SlicePlane plane = axial(block().grid, {0, 0, 0});
  for (auto _ : state) benchmark::DoNotOptimize(slice_image(block(), nullptr, plane).rgba.data());
}
BENCHMARK(BM_AxialSlice)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace trocar::volumes
