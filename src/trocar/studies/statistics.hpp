// Figures of many samples: moments, percentiles, a histogram, and how many are within limits.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace trocar::studies {

/// What may leave the workshop, as deviations from nominal.
struct Limits {
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
};

inline constexpr std::array<double, 5> kPercentiles = {0.135, 2.5, 50, 97.5, 99.865};

struct Statistics {
  std::int64_t samples = 0, open = 0;  ///< asked for; of them: without a value
  double mean = 0;                     ///< deviation from nominal
  double deviation = 0;                ///< standard
  double skewness = 0;
  double low = 0, high = 0;                ///< least and greatest deviation
  std::array<double, 5> percentiles = {};  ///< deviations at kPercentiles
  std::vector<std::int64_t> bins;          ///< of equal width from low to high
  double yield = 0;                        ///< share of all samples within limits; those without a value are not

  bool operator==(const Statistics&) const = default;
};

/// Summed in order, block by block: the same values in the same order give the same bits.
/// @param values  NaN where there is none
Statistics statistics(std::span<const double> values, double nominal, const Limits& limits, int bins = 41);

}  // namespace trocar::studies
