#include <algorithm>
#include <cmath>

#include <trocar/studies/statistics.hpp>

namespace trocar::studies {
namespace {

/// Block sums, added in order: errors of rounding grow by blocks, not by samples.
template <class F>
double sum_of(const std::vector<double>& x, F&& f) {
  constexpr std::size_t kBlock = 4096;
  double sum = 0;
  for (std::size_t from = 0; from < x.size(); from += kBlock) {
    double part = 0;
    for (std::size_t i = from; i < std::min(x.size(), from + kBlock); ++i) part += f(x[i]);
    sum += part;
  }
  return sum;
}

/// Between neighbours of sorted values.
double percentile(const std::vector<double>& sorted, double percent) {
  const double at = percent / 100 * double(sorted.size() - 1);
  const auto below = std::size_t(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - double(below)) * (sorted[above] - sorted[below]);
}

}  // namespace

Statistics statistics(std::span<const double> values, double nominal, const Limits& limits, int bins) {
  Statistics out;
  out.samples = std::int64_t(values.size());
  std::vector<double> x;
  x.reserve(values.size());
  for (const double v : values)
    if (std::isfinite(v)) x.push_back(v - nominal);
  out.open = out.samples - std::int64_t(x.size());
  out.bins.assign(std::size_t(std::max(bins, 1)), 0);
  if (x.empty()) return out;
  const auto n = double(x.size());
  out.mean = sum_of(x, [](double v) { return v; }) / n;
  const double mean = out.mean;
  const double square = sum_of(x, [=](double v) { return (v - mean) * (v - mean); });
  const double cube = sum_of(x, [=](double v) { return (v - mean) * (v - mean) * (v - mean); });
  out.deviation = n > 1 ? std::sqrt(square / (n - 1)) : 0;
  const double spread = std::sqrt(square / n);
  out.skewness = spread > 0 ? cube / n / (spread * spread * spread) : 0;
  out.yield = double(std::count_if(x.begin(), x.end(), [&](double v) { return v >= limits.low && v <= limits.high; })) /
              double(out.samples);
  std::sort(x.begin(), x.end());
  out.low = x.front();
  out.high = x.back();
  for (std::size_t k = 0; k < kPercentiles.size(); ++k) out.percentiles[k] = percentile(x, kPercentiles[k]);
  const double width = out.high - out.low;
  for (const double v : x) {
    const double at = width > 0 ? (v - out.low) / width * bins : 0;
    ++out.bins[std::size_t(std::min(int(at), bins - 1))];
  }
  return out;
}

}  // namespace trocar::studies
