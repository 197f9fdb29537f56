// Peritoneum over a ligament that runs to a wall: two flanks from its sides down to the wall, tangent to it there, so
// that the ligament is a ridge or a fold and no rope, and that is lost in the wall where the ligament has gone into it.
// Near its organ the flanks meet below it in a free, curved edge. One that carries nothing, no vessel and no fold, is
// covered from its beginning: all that shows of it is the ridge. Drawing only; it follows the ligament.
//
//   Ridge ridge(model, strand, walls, backend);
//   ridge.update(state);
#pragma once

#include <trocar/sim/model/state.hpp>
#include <trocar/view/base/heat_marks.hpp>
#include <trocar/view/base/mesh_buffer.hpp>
#include <trocar/view/base/moved.hpp>
#include <trocar/view/base/strand_curve.hpp>
#include <trocar/view/bodies/tube_drawing.hpp>

namespace trocar::view {

class Ridge {
 public:
  /// @param tube  the ligament's drawing; its end is fixed in space
  Ridge(const sim::Model& model, const TubeDrawing& tube, int strand, const WallSurface& walls,
        render::Backend& backend, const Detail& detail = {});

  /// Does it carry something and meet the wall nearly at a right angle? Then a collar ends it (joint.hpp), and it needs
  /// no ridge.
  static bool meets_head_on(const sim::Model& model, const TubeDrawing& tube, int strand, const WallSurface& walls);

  void update(const sim::State& state);
  render::MeshHandle mesh() const { return m_mesh.handle(); }
  const MeshBuffer& buffer() const { return m_buffer; }

 private:
  /// A section across the ligament.
  struct Station {
    double s = 0;              ///< on the strand [m]
    bool beyond = false;       ///< where the ligament is in the wall: `at` stays in space
    Vec3d at, along;           ///< at rest
    Vec3d side;                ///< unit, to the left flank
    double radius = 0;         ///< of what it covers [m]
    double depth = 1;          ///< share of the way to the wall that the flanks reach
    double over = 1;           ///< 0: the ligament's crest is bare, 1: the flanks meet over it
    double gone = 0;           ///< beyond the ligament's end: share of the way on which the ridge is lost
    Vec3d lift;                ///< from the ligament to where it is drawn, where that is in the wall
    Vec3d floor;               ///< the wall below
    Vec3d foot[2], normal[2];  ///< where the flanks end, on either side
  };
  void find_feet(const WallSurface& walls);
  void place(const StrandCurve& curve);
  void place_flank(const Station& st, Vec3d at, int flank, std::size_t first);
  void paint();  ///< from the positions at rest
  void add_root(const TubeRoot& root);
  void add_glide(const WallSurface& walls);
  double crest_above(const Station& station) const;
  void settle_beyond();
  void even_crest(std::size_t station);
  void burn(const sim::State& state);

  const interactions::StrandBody* m_body;
  int m_strand;
  bool m_covered;  ///< from its beginning
  std::vector<Station> m_stations;
  HeatMarks m_marks;
  Moved m_moved;
  std::vector<StrandPiece> m_pieces;  ///< as drawn
  MeshBuffer m_buffer;
  OwnedMesh m_mesh;
};

}  // namespace trocar::view
