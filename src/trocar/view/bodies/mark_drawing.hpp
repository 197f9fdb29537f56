// Marks as they are drawn: a thin disc with a rim and a number, dyed stripes around tubes.
#pragma once

#include <optional>

#include <trocar/view/base/finding_drawing.hpp>
#include <trocar/view/base/listing.hpp>
#include <trocar/view/bodies/tube_drawing.hpp>

namespace trocar::view {

class MarkDrawing {
 public:
  MarkDrawing(const sim::Model& model, int mark, render::Backend& backend);

  /// @param tubes  of the model's strands, as drawn
  void update(const sim::State& state, std::span<const TubeDrawing> tubes);
  void list(std::size_t part, const Listing& to) const;

 private:
  void make_disc();
  void place_disc(const sim::MarkPose& pose);
  void place_stripe(const TubeDrawing& tube);

  const sim::Model* m_model;
  const sim::MarkModel* m_mark;
  render::Backend* m_backend;
  render::Material m_material;
  std::vector<Vec3f> m_flat;  ///< of a disc: right, up [m]
  MeshBuffer m_buffer;
  OwnedMesh m_mesh;
  std::optional<FindingDrawing> m_finding;  ///< changed tissue, in place of all that
  bool m_there = false;                     ///< false: what it was on is cut there
  Vec3d m_place, m_normal;
  std::uint64_t m_version = 0;  ///< of the tube that it was made on
};

}  // namespace trocar::view
