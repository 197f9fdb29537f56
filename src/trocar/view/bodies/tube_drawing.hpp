// A strand as it is drawn: a swept tube of soft, uneven outline, flared where it grows out of an organ, closed by round
// caps, raw faces where it is cut, or fimbriae; flattened by clips and jaws.
//
// A tube is a list of rows (closed rings, poles) that ride on the strand's curve. The list changes only when something
// is cut or clipped; otherwise a frame moves vertices.
#pragma once

#include <trocar/render/meshes/openness.hpp>
#include <trocar/view/base/heat_marks.hpp>
#include <trocar/view/base/level_of_detail.hpp>
#include <trocar/view/base/looks.hpp>
#include <trocar/view/base/moved.hpp>
#include <trocar/view/base/pinch.hpp>
#include <trocar/view/base/strand_curve.hpp>
#include <trocar/view/bodies/wall_surface.hpp>

namespace trocar::view {

/// One ring around the curve, or one vertex on it (radius 0).
struct TubeRow {
  int piece = 0;
  double s = 0;      ///< arc length [m]
  double along = 0;  ///< moved along the tangent from there [m]
  double radius = 0;
  double scallop = 0;   ///< of the rim: share of the radius that it rises and falls by
  double out = 0;       ///< beyond the end, share of the way to the root's target
  bool crease = false;  ///< a hard edge: not joined to the row before, which lies in the same place
  Paint paint;
  double slant = 0;  ///< how far its upper side lies back along the tangent, in radii
  double turn = 0;   ///< of its scallops against those of the piece's rim, in their seed
};

/// Where a strand's end continues below the surface of what holds it. An organ's moves with the strand's end frame, a
/// wall's stays in space.
struct TubeRoot {
  bool there = false, in_space = false;
  Vec3d target, direction;  ///< [m], unit; (tangent, normal, binormal) of the end frame, or world
  double length = 0;        ///< of the way [m]
  double sink = 0;          ///< how deep in the organ's surface the end already lies [m]
};

/// Where the collar of an end begins (joint.hpp): a ring around the strand just outside the organ or wall it goes into.
struct TubeNeck {
  double far = 0;           ///< from the end [m]; 0: this end has no collar
  bool there = false;       ///< false: cut off nearer to the organ
  Vec3d centre, along;      ///< unit: towards the organ
  Vec3d end;                ///< of the strand
  double radius = 0;        ///< [m]
  std::vector<Vec3f> ring;  ///< (sides)
};

class TubeDrawing {
 public:
  /// @param walls  of the model; null: found out
  TubeDrawing(const sim::Model& model, int strand, const Detail& detail = {}, const WallSurface* walls = nullptr);

  /// The undeformed, uncut tube, for baking openness; then its mesh is made.
  const MeshBuffer& drawn() const { return m_buffer; }
  void create(std::vector<Paint> baked, render::Backend& backend);

  void update(const sim::State& state);
  render::MeshHandle mesh() const { return m_mesh.handle(); }
  /// As it was last made: for the folds that hang on it, and for tests.
  const MeshBuffer& buffer() const { return m_buffer; }
  int sides() const { return m_sides; }
  /// Rings (of `sides`) around it as it was last made, from one arc length to the other, `lift` above it [m]: for what
  /// lies on it. Empty where it is cut between them.
  std::vector<Vec3f> band(double from, double to, int rings, float lift) const;
  /// Rises whenever it is drawn again: what follows it looks whether it has to.
  std::uint64_t version() const { return m_version; }
  bool burnt() const { return m_marks.any(); }
  const TubeRoot& end_root() const { return m_end_root; }
  const TubeNeck& neck(bool at_start) const { return m_neck[at_start ? 0 : 1]; }

 private:
  /// What the list of rows depends on.
  struct Layout {
    std::vector<StrandPiece> pieces;
    std::vector<interactions::Clip> clips;
    std::vector<interactions::Cut> nicks;  ///< cuts that went only part of the way
    std::vector<double> loops;             ///< about where loops have sunk in [m]
    bool same(const Layout& other) const;
  };
  Layout layout_of(const sim::State& state) const;
  void lay_out(const Layout& layout);
  void add_piece(const Layout& layout, int piece);
  void add_start(int piece);
  void add_end(int piece);
  double contracted(const StrandPiece& piece, double s) const;
  void add_raw_face(int piece, bool at_start);
  void add_sealed_face(int piece, bool at_start);
  bool sealed(const StrandPiece& piece, bool at_start) const;
  void connect();  ///< vertices and triangles of the rows
  void shape_sections();
  void join(const std::vector<std::size_t>& rows, std::uint32_t stride, MeshBuffer& into) const;
  void join_fimbriae(std::uint32_t fingers, std::uint32_t stride, MeshBuffer& into) const;
  std::vector<std::size_t> rows_apart(double distance) const;
  void connect_coarsely();
  void paint();
  void burn(const sim::State& state);         ///< what heat has left, over the paint
  std::size_t nearest_first(double s) const;  ///< first vertex of the baked row nearest to s
  void place(const StrandCurve& curve, std::vector<Vec3f>& positions) const;
  bool press(const sim::State& state);  ///< true where jaws hold it
  template <class Press>
  void press_piece(const Press& press);
  Paint paint_at(const Layout& layout, double s, double angle, Paint own) const;
  double radius_at(double s) const;
  double outline(double s, double angle) const;
  double spiral(double s, double angle) const;
  double winding(double s) const;
  double bore(double s) const;
  Vec3d coiled(double s, const CurveFrame& f) const;
  bool hosted(int node) const;
  TubeRoot root_at(const StrandCurve& rest, bool at_start, const WallSurface* walls) const;
  TubeRoot root_in_wall(const CurveFrame& end, Vec3d onward, double radius, const WallSurface& walls) const;
  double neck_of(const StrandCurve& rest, bool at_start) const;
  double neck_at_wall(const StrandCurve& rest, bool at_start, const WallSurface& walls) const;
  void place_necks(const StrandCurve& curve);
  void add_root(int piece, bool at_start);
  CurveFrame sunk(const TubeRow& row, CurveFrame f, const StrandCurve& curve) const;
  CurveFrame frame_of(const TubeRow& row, const StrandCurve& curve) const;
  std::vector<double> stations(const Layout& layout, const StrandPiece& piece) const;

  const sim::Model* m_model;
  const sim::StrandAnatomy* m_strand;
  const interactions::StrandBody* m_body;
  const Relief* m_relief;
  int m_index, m_sides;
  TubeRoot m_start_root, m_end_root;
  TubeNeck m_neck[2];  ///< at the start, at the end
  Layout m_layout;
  std::vector<TubeRow> m_rows;
  std::vector<std::uint32_t> m_first;  ///< (rows) vertex
  std::vector<Vec3d> m_section;  ///< (vertices of rows) across, along the curve's normal and binormal; along it [m]
  std::vector<double> m_errors;  ///< (levels) [m]
  HeatMarks m_marks;
  Moved m_moved;
  bool m_held = false;  ///< by jaws, as drawn
  std::uint64_t m_version = 1;
  MeshBuffer m_fimbriae;  ///< in the end's frame
  MeshBuffer m_buffer;
  std::vector<TubeRow> m_baked_rows;  ///< of the uncut tube
  std::vector<Paint> m_baked;
  OwnedMesh m_mesh;
};

}  // namespace trocar::view
