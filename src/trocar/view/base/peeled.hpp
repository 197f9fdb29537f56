// What a wall shows where it was peeled off what it lay on: within the border of its serosa, which has drawn back into
// a pale, low rim, it is raw, reddish, with brown specks where current went along (interactions/couplings/bonds.hpp
// says what parted).
//
//   Peeled peeled(model, membrane, places);      // of the drawn vertices, at rest
//   if (peeled.update(state)) paint with peeled.at(vertex);
#pragma once

#include <span>
#include <vector>

#include <trocar/sim/model/state.hpp>

namespace trocar::view {

class Peeled {
 public:
  struct Mark {
    std::uint8_t blood = 0, burn = 0;  ///< as in render::Paint
    float high = 0;                    ///< [m] above the wall
  };

  /// @param membrane  whose bonds count  @param places  [m]
  Peeled(const sim::Model& model, int membrane, std::span<const Vec3d> places);

  /// True where a bond has parted, or dried, since the last time.
  bool update(const sim::State& state);
  const Mark& at(std::size_t vertex) const { return m_marks[vertex]; }

 private:
  struct Root {
    std::size_t set = 0, bond = 0;
    Vec3f at;  ///< on the wall, at rest [m]
  };
  Mark mark(std::size_t vertex, const sim::State& state) const;

  std::vector<Vec3f> m_places;
  std::vector<Root> m_roots;
  std::vector<std::vector<std::uint16_t>> m_near;  ///< (places) roots
  std::vector<std::int32_t> m_seen;                ///< (roots) BondState::cause, -1 while it holds
  std::vector<Mark> m_marks;                       ///< (places)
};

}  // namespace trocar::view
