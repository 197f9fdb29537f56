// A thin fold between a strand and its base line: a ruled surface that sags and ripples where it is slack, goes flat
// where it is stretched, gapes where the strand on its border is cut, and runs out on the wall or organ beside it.
#pragma once

#include <optional>

#include <trocar/sim/model/state.hpp>
#include <trocar/view/base/level_of_detail.hpp>
#include <trocar/view/base/strand_curve.hpp>
#include <trocar/view/bodies/sheet_crescent.hpp>
#include <trocar/view/bodies/wall_surface.hpp>

namespace trocar::view {

class SheetDrawing {
 public:
  /// @param walls  what a base that nothing carries runs out on; null: found out
  SheetDrawing(const sim::Model& model, int sheet, render::Backend& backend, const Detail& detail = {},
               const WallSurface* walls = nullptr);

  void update(const sim::State& state);
  render::MeshHandle mesh() const { return m_mesh.handle(); }
  const MeshBuffer& buffer() const { return m_buffer; }
  /// Nothing carries its base: it continues to a wall and is lost there.
  bool has_hem() const { return !m_hem.empty(); }

 private:
  /// A line from the strand to the base.
  struct Column {
    int piece = 0;
    double s = 0;    ///< on the strand [m]
    int twin = -1;   ///< column on the other side of a cut
    double gap = 1;  ///< 0 at a cut .. 1 far from it
  };
  /// What a row of a free edge runs out on: an organ's skin.
  struct Margin {
    int organ = -1, vertex = -1;
  };
  void find_ends(const WallSurface& walls);
  /// Part of a ligament that runs to the wall beside an end.
  struct Ligament {
    int strand = -1;
    double from = 0;  ///< [m] of it: there the sheet meets it
  };
  void find_margin(bool at_end);
  Ligament ligament_near(Vec3d tip) const;
  std::vector<Vec3d> ligament_points(bool at_end, const sim::State& state) const;
  void find_crescent(bool at_end, const WallSurface& walls);
  std::vector<Vec3d> beside(bool at_end, const StrandCurve& curve) const;
  int beyond(bool at_end) const;
  void find_hem(const WallSurface& walls);
  void place_hem();
  void place_margin(const sim::State& state, bool at_end);
  void place_crescent(const sim::State& state, const StrandCurve& curve, bool at_end);
  void lay_out(std::vector<StrandPiece> pieces);
  void connect();
  void connect_end(bool at_end);
  double wall_tint(std::size_t columns_left, double v) const;
  void lay_pattern();
  void place(const sim::State& state);
  void even_out(std::vector<Vec3d>& of_columns) const;
  void close_tear(std::size_t column);
  void place_column(std::size_t column, Vec3d top, Vec3d base, Vec3d across);
  Vec3d base_point(std::size_t i, const sim::State& state) const;
  Vec3d base_at(double share) const;

  const sim::Model* m_model;
  const sim::DrawnFold* m_sheet;
  const interactions::StrandBody* m_body;
  std::vector<StrandPiece> m_pieces;
  std::vector<Column> m_columns;
  std::vector<double> m_base_share;            ///< of the drawn base line's length, 0..1
  std::vector<Vec3d> m_base;                   ///< now
  std::vector<double> m_rest_width;            ///< (columns) drawn
  std::vector<Margin> m_margin[2];             ///< (rows) at the first and last column; empty: no organ is near
  std::optional<SheetCrescent> m_crescent[2];  ///< there the sheet goes over to a wall
  Ligament m_onto[2];                          ///< which ligament that one's border runs along
  std::size_t m_beyond_first[2] = {0, 0};      ///< vertices of either
  std::vector<Vec3d> m_hem;                    ///< (columns) where the sheet ends below its base; empty: at its base
  std::uint32_t m_hem_first = 0;               ///< vertex
  MeshBuffer m_buffer;
  OwnedMesh m_mesh;
};

}  // namespace trocar::view
