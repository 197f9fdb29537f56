// A volume of fluid in whole picolitres, by species. Integers, so that what leaves one place and arrives at another is
// the same to the last picolitre, in whatever order it is added up. 1 mL = 10^9 pL; 64 bits hold 9 million litres.
//
//   Mix drop{.blood = 4'000'000};                       // 4 microlitres
//   const Mix part = share(drop, 1'000'000);            // a quarter of it, of the same composition
//   drop -= part;
#pragma once

#include <cstdint>

#include <trocar/core/fields.hpp>

namespace trocar::fluids {

inline constexpr double kPicolitresPerM3 = 1e15;
inline constexpr double kM3PerPicolitre = 1e-15;
inline constexpr std::int64_t kMillilitre = 1'000'000'000;  ///< [pL]
inline constexpr std::int64_t kMicrolitre = 1'000'000;      ///< [pL]

struct Mix {
  std::int64_t blood = 0, saline = 0, bile = 0;  ///< [pL]

  constexpr std::int64_t total() const { return blood + saline + bile; }
  constexpr bool empty() const { return blood == 0 && saline == 0 && bile == 0; }
  constexpr Mix& operator+=(const Mix& o) {
    blood += o.blood;
    saline += o.saline;
    bile += o.bile;
    return *this;
  }
  constexpr Mix& operator-=(const Mix& o) {
    blood -= o.blood;
    saline -= o.saline;
    bile -= o.bile;
    return *this;
  }
  friend constexpr Mix operator+(Mix a, const Mix& b) { return a += b; }
  friend constexpr Mix operator-(Mix a, const Mix& b) { return a -= b; }
  friend constexpr bool operator==(const Mix& a, const Mix& b) {
    return a.blood == b.blood && a.saline == b.saline && a.bile == b.bile;
  }

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("blood", s.blood), v("saline", s.saline), v("bile", s.bile);
  }
};

/// What blood is besides how much: in the mean, when several come together.
struct Blood {
  float born = 0;    ///< when it left the vessels [s]
  float venous = 0;  ///< share of it that came from veins, 0 .. 1

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("born", s.born), v("venous", s.venous);
  }
};
/// Mean of two bloods by their volumes [pL].
Blood mean(Blood a, std::int64_t volume_a, Blood b, std::int64_t volume_b) noexcept;

/// Densities of the species at 37 C [kg/m^3].
struct Densities {
  double blood = 1060, saline = 1005, bile = 1010;

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("blood", s.blood), v("saline", s.saline), v("bile", s.bile);
  }
};
constexpr double mass(const Mix& m, const Densities& rho) {  ///< [kg]
  return kM3PerPicolitre * (rho.blood * double(m.blood) + rho.saline * double(m.saline) + rho.bile * double(m.bile));
}

/// `amount` picolitres of a mix, composed as the whole as far as whole picolitres allow: never more of a species than
/// there is, and exactly `amount` in all.
/// @param amount  clamped to 0 .. m.total()
Mix share(const Mix& m, std::int64_t amount) noexcept;

/// Whole picolitres of a flow that lasts dt; the fraction left over is carried to the next call, so that nothing is
/// lost in the long run.
/// @param flow   [m^3/s]; what is not finite or negative counts as 0
/// @param carry  in/out: the fraction [pL], 0 .. 1
std::int64_t whole_picolitres(double flow, double dt, double& carry) noexcept;

inline constexpr std::int64_t kMostAtOnce = 10 * kMillilitre;  ///< of one flow in one call: 600 L/min at 1 ms

}  // namespace trocar::fluids
