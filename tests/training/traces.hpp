// Made-up traces for the tests of traces and metrics.
#pragma once

#include <functional>

#include <trocar/training/metrics/trace.hpp>

namespace trocar::traces {

/// A trace of `hands` hands over `seconds`, each sample from make(hand, time).
inline training::Trace make(int hands, double seconds,
                            const std::function<training::TraceSample(int, double)>& make_sample) {
  training::Trace trace;
  trace.instruments = {"grasper", "scissors"};
  const auto n = std::size_t(seconds * trace.rate + 0.5) + 1;
  for (int h = 0; h < hands; ++h) {
    trace.hands.push_back({h == 0 ? "left" : (h == 1 ? "right" : "third"), true, {}});
    for (std::size_t i = 0; i < n; ++i) trace.hands.back().samples.push_back(make_sample(h, trace.time(i)));
  }
  return trace;
}

}  // namespace trocar::traces
