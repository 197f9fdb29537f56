#include <algorithm>

#include <trocar/interactions/instrument/linkage.hpp>

namespace trocar::interactions {
namespace {

/// A table's value at a place of the handle.
double at_handle(const double (&table)[kLinkageSteps + 1], double handle) noexcept {
  const double place = std::clamp(handle, 0.0, 1.0) * kLinkageSteps;
  const int step = std::min(int(place), kLinkageSteps - 1);
  return table[step] + (place - step) * (table[step + 1] - table[step]);
}

}  // namespace

double aperture_of(const LinkageModel& l, double handle) noexcept {
  return l.there ? at_handle(l.aperture, handle) : 1.0 - handle;
}

double handle_of(const LinkageModel& l, double aperture) noexcept {
  if (!l.there) return 1.0 - aperture;
  int low = 0, high = kLinkageSteps;  // aperture[low] >= aperture > aperture[high], as it falls
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    (l.aperture[middle] >= aperture ? low : high) = middle;
  }
  const double share = (l.aperture[low] - aperture) / (l.aperture[low] - l.aperture[high]);
  return (low + std::clamp(share, 0.0, 1.0)) / kLinkageSteps;
}

double leverage_at(const LinkageModel& l, double aperture) noexcept {
  return l.there ? at_handle(l.leverage, handle_of(l, aperture)) : 1.0;
}

}  // namespace trocar::interactions
