// Where the end of a fold that hangs in the air goes over to the wall beside it: the fold's free border is a hollow
// curve, a crescent, that leaves the strand along it and arrives on the wall along that, as folds of peritoneum do.
// Where a ligament runs to the wall near by, the border goes down to that and along it, as the broad ligament goes over
// into the infundibulopelvic one: it has no free edge then. The patch between the fold's last column, the strand, the
// wall and that curve is a Coons patch [Coons 67].
//
//   SheetCrescent crescent(base, beside, ligament, walls);        // at rest
//   crescent.place(column, before, beside, ligament, positions);  // now
#pragma once

#include <span>
#include <vector>

#include <trocar/view/base/mesh_buffer.hpp>
#include <trocar/view/bodies/wall_surface.hpp>

namespace trocar::view {

class SheetCrescent {
 public:
  static constexpr int kSteps = 14;        ///< columns from the fold's last one to the free border
  static constexpr double kAlong = 0.016;  ///< [m] of the strand over which the fold narrows to nothing

  /// @param base      where the fold's last column ends, at rest
  /// @param beside    (kSteps + 1) points of the strand from that column on, at rest
  /// @param ligament  points of one near by, from where the border meets it to its end in the wall; empty: none
  SheetCrescent(Vec3d base, std::span<const Vec3d> beside, std::span<const Vec3d> ligament, const WallSurface& walls);
  /// False: no wall is near.
  bool there() const { return !m_on_wall.empty(); }

  /// @param column  the fold's last one, strand to base  @param before  the one before it: the patch continues from
  /// both
  /// @param out  (kSteps x column.size())
  void place(std::span<const Vec3f> column, std::span<const Vec3f> before, std::span<const Vec3d> beside,
             std::span<const Vec3d> ligament, std::span<Vec3f> out) const;
  /// Of column `step` (1 .. kSteps) at share v of the way from strand to base. @param hung  its border is on a ligament
  static Paint paint(int step, double v, bool hung);

 private:
  Vec3d free_border(double v, Vec3d tip, Vec3d along) const;

  void lay_on_wall(std::size_t rows, std::span<Vec3f> out) const;

  std::vector<Vec3d> m_on_wall;  ///< (kSteps + 1) from the base to where the free border arrives
  std::vector<Vec3d> m_normal;   ///< of the wall there
};

}  // namespace trocar::view
