// The account of every picolitre: what came in is somewhere.
//
//   bled + irrigated = droplets + film + pool + sucked + drained      for each species, exactly, at every tick
//
// Fluid enters by receive() and goes from place to place by move(); nothing else changes the account. balanced() says
// whether the two sides agree; audit() also adds up what the droplets, the film and the pool really hold (fluids.hpp).
//
//   receive(ledger, Source::kBled, Place::kDroplets, drop);
//   move(ledger, Place::kDroplets, Place::kPool, drop);
//   const double lost_ml = double(ledger.in[int(Source::kBled)].blood) / kMillilitre;
#pragma once

#include <array>

#include <trocar/core/fields.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/fluids/mix.hpp>

namespace trocar::fluids {

enum class Source : std::int8_t { kBled, kIrrigated };  ///< bled: blood and bile that leave their vessels
enum class Place : std::int8_t { kDroplets, kFilm, kPool, kSucked, kDrained };
inline constexpr int kSources = 2, kPlaces = 5;

struct Ledger {
  std::array<Mix, kSources> in;  ///< since the beginning [pL]
  std::array<Mix, kPlaces> at;   ///< now; sucked and drained: since the beginning [pL]

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("in", s.in, core::kEach), v("at", s.at, core::kEach);
  }
};

inline void receive(Ledger& ledger, Source source, Place to, const Mix& m) noexcept {
  ledger.in[std::size_t(source)] += m;
  ledger.at[std::size_t(to)] += m;
}
inline void move(Ledger& ledger, Place from, Place to, const Mix& m) noexcept {
  ledger.at[std::size_t(from)] -= m;
  ledger.at[std::size_t(to)] += m;
}
inline const Mix& at(const Ledger& ledger, Place place) noexcept { return ledger.at[std::size_t(place)]; }

/// What came in less what is anywhere: zero for each species.
Mix imbalance(const Ledger& ledger) noexcept;
/// No imbalance, and no place holds less than nothing.
bool balanced(const Ledger& ledger) noexcept;

void add_to_hash(core::Hasher& hasher, const Ledger& ledger) noexcept;

}  // namespace trocar::fluids
