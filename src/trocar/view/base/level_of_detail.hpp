// How finely things are drawn, by how far off they are: each has levels, from which distance on it has fewer triangles
// and a simpler surface. What the scene's file does not say has the levels below, which are not seen to be coarser.
//
//   Detail detail(levels_of(model, "uterus"));
//   const auto lists = coarser_lists(positions, indices, paint, detail, kBends);     // of the mesh, once
//   item.level = detail.level_at(eye.distance(points, transform), eye.index);        // every frame
//
// Distances are those of a picture 600 px high through a lens of 70 degrees; another picture's are converted, so that a
// thing changes at the same size in pixels. The governor moves all borders nearer (render::Quality::coarser).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <trocar/render/frame/frame.hpp>
#include <trocar/sim/model/model.hpp>
#include <trocar/view/base/mesh_buffer.hpp>

namespace trocar::view {

inline constexpr double kReferenceHeight = 600;         ///< [px] of the picture that distances are meant for
inline constexpr double kReferenceTangent = 0.7002075;  ///< of half of 70 degrees
inline constexpr double kHysteresis = 0.06;             ///< of a border's distance, to either side

/// Of a thing of this name (as in the scene; instruments by their own): what the file says, else the default.
std::vector<sim::DetailLevel> levels_of(const sim::Model& model, const std::string& name);

/// Levels of one thing, and which it has now. Each eye has its own (ViewOptions::eye_index).
class Detail {
 public:
  Detail() = default;
  explicit Detail(std::vector<sim::DetailLevel> levels) : m_levels(std::move(levels)) {}

  const std::vector<sim::DetailLevel>& levels() const { return m_levels; }
  /// 0: all that there is; k: the k-th level. Near a border it stays what it was: nothing flickers.
  std::uint8_t level_at(double distance, int eye);
  /// Its surface at that level, as Quality::detail has it.
  std::uint8_t surface(std::uint8_t level) const;

 private:
  std::vector<sim::DetailLevel> m_levels;
  std::array<std::uint8_t, 8> m_level{};
};

/// Where a picture is taken from.
struct DetailEye {
  Vec3f position, forward;
  float edge = 0.5f;  ///< cosine of the half angle in which things are seen, with a margin
  double scale = 1;   ///< from metres to a distance as levels mean it
  int index = 0;

  /// @param height [px] of the picture
  DetailEye(const render::Camera& camera, double height, const render::Quality& quality, int index);
  /// To the nearest of some of the points, as levels mean it; what is out of sight counts as twice as far.
  double distance(std::span<const Vec3f> points, const render::Mat4& transform = {}) const;
};

/// [m] how long an edge may be where things bend.
inline constexpr double kBends = 0.008, kRigid = 1.0;

/// A list of triangles for each of the levels.
std::vector<std::vector<std::uint32_t>> coarser_lists(std::span<const Vec3f> positions,
                                                      std::span<const std::uint32_t> indices,
                                                      std::span<const Paint> paint, const Detail& detail,
                                                      double longest_edge);

/// Of a mesh that will not change its triangles.
void coarsen(MeshBuffer& mesh, const Detail& detail, double longest_edge);

/// How a swept tube loses rings and sides: the way from ring to ring where it bends with radius `bend`, and of how many
/// sides one is left, of `sides` of a tube of this radius. [m]
double ring_distance(double error, double bend);
std::uint32_t side_stride(double error, double radius, std::uint32_t sides);

}  // namespace trocar::view
