#include <algorithm>

#include <trocar/numerics/portable.hpp>
#include <trocar/tissue/heat/electrosurgery_seal.hpp>

namespace trocar::tissue {

double sealing_calibre(const SealDescription& d, double compression) noexcept {
  return d.bare + (d.pressed - d.bare) * std::clamp(compression, 0.0, 1.0);
}

void seal(const HeatDescription& tissue, const SealDescription& d, const SealInput& in, double dt,
          SealState& s) noexcept {
  const double over = in.diameter / sealing_calibre(d, in.compression) - 1;
  const double close = std::clamp(1 - over / 0.2, 0.0, 1.0);
  const double celsius = std::min(in.temperature, HeatModel::kRateUpTo);
  s.damage = std::min(s.damage + dt * damage_rate(tissue, celsius) * close, 1e6);
  s.char_ = std::max(s.char_, std::clamp(in.char_, 0.0, 1.0));
}

double seal_quality(const SealDescription& d, const SealState& s) noexcept {
  return (1 - portable::exp(-s.damage / d.needed)) * (1 - d.brittle * s.char_);
}

double burst_pressure(const SealDescription& d, const SealState& s) noexcept {
  const double quality = seal_quality(d, s);
  return d.strongest * quality * quality;
}

void add_to_hash(core::Hasher& hasher, const SealState& s) noexcept { hasher.add(s); }

}  // namespace trocar::tissue
