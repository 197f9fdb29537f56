#include <algorithm>

#include <trocar/fluids/mix.hpp>

namespace trocar::fluids {

namespace {

/// Puts of `rest` where it fits, which may be less than nothing; what does not is left in it.
void settle(std::int64_t of, std::int64_t& out, std::int64_t& rest) noexcept {
  const std::int64_t room = of - out;
  std::int64_t fit = rest < room ? rest : room;
  fit = fit < -out ? -out : fit;
  out += fit;
  rest -= fit;
}

}  // namespace

Mix share(const Mix& m, std::int64_t amount) noexcept {
  const std::int64_t whole = m.total();
  if (amount <= 0) return {};
  if (amount >= whole) return m;
  if (m.blood == whole) return {.blood = amount};
  const double f = double(amount) / double(whole);
  const auto part = [f](std::int64_t of) {
    const auto some = std::int64_t(double(of) * f);
    return of < some ? of : some;
  };
  Mix out{.blood = part(m.blood), .saline = part(m.saline), .bile = part(m.bile)};
  // What rounding has left over (a few picolitres; of either sign where doubles round up) goes where there is room.
  std::int64_t rest = amount - out.total();
  settle(m.blood, out.blood, rest), settle(m.saline, out.saline, rest), settle(m.bile, out.bile, rest);
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

Blood mean(Blood a, std::int64_t volume_a, Blood b, std::int64_t volume_b) noexcept {
  if (volume_a <= 0 || volume_b <= 0) return volume_b > 0 ? b : a;
  const float part = float(volume_b) / float(volume_a + volume_b);
  return {a.born + (b.born - a.born) * part, a.venous + (b.venous - a.venous) * part};
}

}  // namespace trocar::fluids
