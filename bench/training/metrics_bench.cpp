// What an attempt's end costs: ten minutes of three hands as metrics, as bytes and as CSV.
#include <cmath>

#include <benchmark/benchmark.h>

#include <trocar/training/metrics/metrics.hpp>

using namespace trocar;
using namespace trocar::training;

namespace {

/// Hands that move, rest and pull, with the tremor that makes a trace hard to pack.
const Trace& ten_minutes() {
  static const Trace made = [] {
    Trace trace;
    for (const char* name : {"left", "right", "third"}) trace.hands.push_back({name, true, {}});
    for (std::size_t i = 0; i < 30'000; ++i) {
      const double t = trace.time(i);
      for (std::size_t h = 0; h < 3; ++h) {
        const double phase = t + 2.1 * double(h), works = std::sin(0.05 * phase) > 0 ? 1 : 0;
        TraceSample s;
        s.tip = {works * 0.03 * std::sin(phase) + 1e-4 * std::sin(45 * phase), works * 0.02 * std::sin(1.7 * phase),
                 -0.1};
        s.orientation = quat_from_rotation_vector(Vec3d{0.3 * std::sin(phase), 0.2 * std::sin(1.3 * phase), 0.1});
        s.pull = {works * std::sin(phase), 0, works};
        s.pinch = 5 * works;
        trace.hands[h].samples.push_back(rounded(s));
      }
      trace.scope.push_back({});
    }
    return trace;
  }();
  return made;
}

void MetricsOfTenMinutes(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(metrics_of(ten_minutes()).time);
}
BENCHMARK(MetricsOfTenMinutes)->Unit(benchmark::kMillisecond);

void TraceToBytes(benchmark::State& state) {
  std::size_t size = 0;
  for (auto _ : state) size = to_bytes(ten_minutes()).size();
  state.counters["bytes_per_second_of_attempt"] = double(size) / 600;
}
BENCHMARK(TraceToBytes)->Unit(benchmark::kMillisecond);

void TraceFromBytes(benchmark::State& state) {
  const std::vector<std::uint8_t> bytes = to_bytes(ten_minutes());
  for (auto _ : state) benchmark::DoNotOptimize(trace_from_bytes(bytes, "bench").size());
}
BENCHMARK(TraceFromBytes)->Unit(benchmark::kMillisecond);

void TraceToCsv(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(to_csv(ten_minutes()).size());
}
BENCHMARK(TraceToCsv)->Unit(benchmark::kMillisecond);

}  // namespace
