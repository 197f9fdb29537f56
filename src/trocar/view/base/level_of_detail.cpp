#include <algorithm>
#include <cmath>
#include <mutex>
#include <unordered_map>

#include <trocar/core/hash.hpp>
#include <trocar/geometry/surfaces/coarsen.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/view/base/level_of_detail.hpp>

namespace trocar::view {
namespace {

// Half a pixel is 0.07 mm at 60 mm. The last is for small pictures.
const std::vector<sim::DetailLevel> kDefault{
    {0.060, 0.00007, 2}, {0.120, 0.00015, 2}, {0.240, 0.0004, 0}, {0.600, 0.001, 0}};

constexpr std::size_t kLooks = 96;      // points of a thing whose distance is looked at
constexpr float kPaintLength = 1e-3f;   // [m] that a change of paint from none to all counts
constexpr float kDetailMargin = 0.25f;  // [rad] beside the picture
constexpr std::uint32_t kLeastSides = 4;
constexpr std::size_t kMostKept = 256;  // meshes: of a scene or two

using Lists = std::vector<std::vector<std::uint32_t>>;

/// All that coarser lists depend on.
struct Uncoarsened {
  std::vector<Vec3f> positions, notes;
  std::vector<std::uint32_t> indices;
  std::vector<double> errors;
  double longest_edge = 0;

  bool operator==(const Uncoarsened&) const = default;
  std::uint64_t hash() const {
    const auto of = [](const auto& list, std::uint64_t seed) {
      return core::hash_bytes(list.data(), list.size() * sizeof list[0], seed);
    };
    return of(indices, of(notes, of(positions, 0)));
  }
};

/// Half of the time that a scene takes to be prepared for drawing goes into coarsening, and who tries an exercise again
/// has the same meshes: what was made once is kept.
Lists kept_or_coarsened(Uncoarsened mesh) {
  static std::mutex mutex;
  static std::unordered_map<std::uint64_t, std::pair<Uncoarsened, Lists>> kept;
  const std::lock_guard lock(mutex);
  const std::uint64_t hash = mesh.hash();
  const auto known = kept.find(hash);
  if (known != kept.end() && known->second.first == mesh) return known->second.second;
  if (kept.size() >= kMostKept) kept.clear();
  Lists lists = geometry::coarsened(mesh.positions, mesh.indices, mesh.notes, mesh.errors, mesh.longest_edge);
  kept.insert_or_assign(hash, std::pair(std::move(mesh), lists));
  return lists;
}

}  // namespace

std::vector<sim::DetailLevel> levels_of(const sim::Model& model, const std::string& name) {
  for (const sim::DrawnDetail& d : model.drawn_detail)
    if (d.name == name) return d.levels;
  return kDefault;
}

std::uint8_t Detail::level_at(double distance, int eye) {
  std::uint8_t& level = m_level[std::size_t(eye)];
  while (level < m_levels.size() && distance > m_levels[level].from * (1 + kHysteresis)) ++level;
  while (level > 0 && distance < m_levels[level - std::size_t(1)].from * (1 - kHysteresis)) --level;
  return level;
}

std::uint8_t Detail::surface(std::uint8_t level) const {
  return level == 0 ? std::uint8_t(2) : std::uint8_t(m_levels[level - std::size_t(1)].surface);
}

DetailEye::DetailEye(const render::Camera& camera, double height, const render::Quality& quality, int eye)
    : position(camera.position), forward(-camera.rotation.column(2)), index(eye) {
  const float half = camera.vertical_fov / 2;
  const float corner = std::atan(1.7f * std::tan(half));  // pictures are wider than high
  edge = std::cos(std::min(corner + kDetailMargin, 3.0f));
  scale = kReferenceHeight / (height * double(quality.render_scale)) * std::tan(double(half)) / kReferenceTangent *
          double(quality.coarser);
}

double DetailEye::distance(std::span<const Vec3f> points, const render::Mat4& transform) const {
  float nearest = 1e9f;
  for (std::size_t i = 0; i < points.size(); i += std::max<std::size_t>(1, points.size() / kLooks)) {
    const Vec3f way = render::transform_point(transform, points[i]) - position;
    const float far = length(way);
    nearest = std::min(nearest, dot(way, forward) < edge * far ? 2 * far : far);
  }
  return scale * double(nearest);
}

std::vector<std::vector<std::uint32_t>> coarser_lists(std::span<const Vec3f> positions,
                                                      std::span<const std::uint32_t> indices,
                                                      std::span<const Paint> paint, const Detail& detail,
                                                      double longest_edge) {
  if (detail.levels().empty()) return {};
  Uncoarsened mesh{{positions.begin(), positions.end()}, {}, {indices.begin(), indices.end()}, {}, longest_edge};
  for (const Paint& p : paint)
    mesh.notes.push_back((kPaintLength / 255) *
                         Vec3f{float(p.openness), float(p.tint), float(p.blood) + float(p.burn)});
  for (const sim::DetailLevel& level : detail.levels()) mesh.errors.push_back(level.error);
  return kept_or_coarsened(std::move(mesh));
}

void coarsen(MeshBuffer& mesh, const Detail& detail, double longest_edge) {
  mesh.coarser = coarser_lists(mesh.positions, mesh.indices, mesh.paint, detail, longest_edge);
}

double ring_distance(double error, double bend) { return std::sqrt(8 * bend * error); }

std::uint32_t side_stride(double error, double radius, std::uint32_t sides) {
  std::uint32_t stride = 1;
  for (std::uint32_t wider = 2; sides % wider == 0 && sides / wider >= kLeastSides; wider *= 2)
    if (radius * (1 - std::cos(portable::pi * wider / sides)) <= error) stride = wider;
  return stride;
}

}  // namespace trocar::view
