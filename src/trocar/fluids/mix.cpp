#include <algorithm>

#include <trocar/fluids/mix.hpp>

namespace trocar::fluids {

Mix share(const Mix& m, std::int64_t amount) noexcept {
  const std::int64_t whole = m.total();
  if (amount <= 0) return {};
  if (amount >= whole) return m;
  const double f = double(amount) / double(whole);
  const auto part = [f](std::int64_t of) { return std::min(of, std::int64_t(double(of) * f)); };
  Mix out{.blood = part(m.blood), .saline = part(m.saline), .bile = part(m.bile)};
  // What rounding has left over (a few picolitres; of either sign where doubles round up) goes where there is room.
  std::int64_t rest = amount - out.total();
  for (std::int64_t Mix::*species : {&Mix::blood, &Mix::saline, &Mix::bile}) {
    const std::int64_t fit = std::clamp(rest, -(out.*species), m.*species - out.*species);
    out.*species += fit;
    rest -= fit;
  }
  return out;
}

std::int64_t whole_picolitres(double flow, double dt, double& carry) noexcept {
  const double most = double(kMostAtOnce);
  double volume = flow * dt * kPicolitresPerM3;
  if (!(volume > 0)) volume = 0;
  if (!(carry >= 0 && carry < 1)) carry = 0;
  volume = std::min(volume, most) + carry;
  const auto whole = std::int64_t(volume);
  carry = volume - double(whole);
  return whole;
}

}  // namespace trocar::fluids
