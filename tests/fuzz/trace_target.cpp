// The two readers of a Trace: the bytes that the session store keeps, and the CSV that people exchange.
#include <algorithm>
#include <cstring>

#include <trocar/core/error.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/core/random.hpp>
#include <trocar/training/metrics/metrics.hpp>
#include <trocar/training/metrics/trace.hpp>

#include "targets.hpp"

namespace trocar::fuzz {
namespace {

using training::Trace;

void check(const Trace& trace) {
  for (const training::TraceHand& hand : trace.hands)
    require(hand.samples.size() == trace.size(), "all hands have the same number of samples");
  require(trace.scope.empty() || trace.scope.size() == trace.size(), "so has the scope");
  require(trace.size() <= training::kMaxTraceSamples && trace.hands.size() <= training::kMaxTraceHands,
          "a trace is bounded");
  const std::vector<std::uint8_t> bytes = training::to_bytes(trace);
  require(training::trace_from_bytes(bytes, "again") == trace, "what was read can be stored and read again");
  if (trace.size() <= 500) require(!training::metrics_json(trace).empty(), "any trace can be measured");
  if (trace.size() > 2000) return;  // CSV is long
  const std::string csv = training::to_csv(trace);
  const Trace back = training::trace_from_csv(csv, "again");
  require(back.size() == trace.size(), "as CSV, too");
  if (back.rate == trace.rate)  // CSV keeps six decimals of it; times follow from it
    require(training::to_csv(back) == csv, "with the same numbers");
}

Trace sample(int samples, int hands, bool scope) {
  Trace t;
  t.instruments = {"grasper", "scissors"};
  core::Random random(3);
  for (int h = 0; h < hands; ++h) {
    training::TraceHand hand;
    hand.name = h == 0 ? "left_lateral" : "suprapubic";
    for (int i = 0; i < samples; ++i) {
      training::TraceSample s;
      s.tip = {0.001 * i, random.uniform(-0.1, 0.1), 0};
      s.handle = random.uniform();
      s.instrument = h;
      hand.samples.push_back(training::rounded(s));
    }
    t.hands.push_back(hand);
  }
  if (scope) t.scope.assign(std::size_t(samples), training::rounded(training::TraceScope{{0, 0, 0.1}, {0, 0, -1}}));
  if (samples > 3) t.marks.push_back({training::TraceMark::clipped, 0, 2});
  return t;
}

}  // namespace

void trace_bytes(Bytes bytes) {
  Trace trace;
  try {
    trace = training::trace_from_bytes(bytes, "memory");
  } catch (const core::BadInput& bad) {
    return require(!bad.faults().empty() && !bad.faults().front().message.empty(), "a refusal has a reason");
  }
  check(trace);
}

void trace_csv(Bytes bytes) {
  Trace trace;
  try {
    trace = training::trace_from_csv(text_of(bytes), "memory.csv");
  } catch (const core::BadInput& bad) {
    return require(!bad.faults().empty() && !bad.faults().front().message.empty(), "a refusal has a reason");
  }
  check(trace);
}

std::vector<Seed> trace_seeds() {
  return {{"small", training::to_bytes(sample(5, 2, true))},
          {"still", training::to_bytes(sample(1, 1, false))},
          {"long", training::to_bytes(sample(60, 1, true))}};
}

std::vector<Seed> trace_csv_seeds() {
  return {{"small", bytes_of(training::to_csv(sample(5, 2, true)))},
          {"still", bytes_of(training::to_csv(sample(1, 1, false)))}};
}

/// Any change, and the checksum behind it written anew.
std::size_t mutate_trace(std::uint8_t* data, std::size_t size, std::size_t capacity, unsigned seed) {
  constexpr std::size_t sum = sizeof(std::uint64_t);
  if (size <= sum || seed % 8 == 0) return plain_mutation(data, size, capacity);
  const std::size_t now = plain_mutation(data, size - sum, capacity - sum);
  const std::uint64_t hash = core::hash_bytes(data, now);
  std::memcpy(data + now, &hash, sum);
  return now + sum;
}

}  // namespace trocar::fuzz
