#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/render/meshes/mesh_arrays.hpp>
#include <trocar/sim/model/state.hpp>
#include <trocar/view/bodies/digits.hpp>
#include <trocar/view/bodies/mark_drawing.hpp>

namespace trocar::view {
namespace {

constexpr int kGrid = 44;                                // cells along a disc's edge: 0.1 mm of one of 5 mm
constexpr double kMarkAbove = 0.00015;                   // [m] a disc above what it lies on
constexpr double kMarkBevel = 0.00012;                   // [m] by which its border falls
constexpr double kLabelHigh = 0.84, kLabelBeside = 0.7;  // of the radius: one digit, more of them
constexpr double kRimFrom = 0.86, kRimTo = 0.93;         // of the radius: a thin ring
constexpr int kMarkRings = 5;                            // of a stripe
constexpr float kStripeLift = 0.00006f;                  // [m] above its tube

struct Dye {
  const char* name;
  Vec3f colour;
  bool dark;
};

const Dye& dye(const std::string& name) {
  static const Dye all[] = {
      {"white", render::srgb(178, 176, 170), false}, {"yellow", render::srgb(178, 148, 40), false},
      {"orange", render::srgb(184, 104, 40), false}, {"green", render::srgb(62, 132, 84), true},
      {"blue", render::srgb(44, 86, 158), true},     {"black", render::srgb(36, 36, 40), true},
  };
  for (const Dye& d : all)
    if (name == d.name) return d;
  return all[0];
}

/// Dull paint: no vessels, no film.
render::Material painted(const Dye& d) {
  render::Material m;
  m.colour = m.colour_b = m.colour_c = d.colour;
  m.tint = d.dark ? render::srgb(226, 224, 218) : render::srgb(26, 26, 30);
  m.mottle = m.bump = m.vessels = m.wetness = m.film_bump = m.glow_amount = 0;
  m.roughness = 0.7f;
  m.wrap = {0.2f, 0.2f, 0.2f};
  return m;
}

/// Where a grid's point (-1..1 both) lies in a round disc, without a seam.              [Shirley & Chiu 97]
Vec3d in_disc(double a, double b) {
  constexpr double pi = portable::pi;
  if (a == 0 && b == 0) return {};
  const bool steep = std::fabs(b) > std::fabs(a);
  const double r = steep ? b : a, angle = steep ? pi / 2 - pi / 4 * (a / b) : pi / 4 * (b / a);
  return {r * std::cos(angle), r * std::sin(angle), 0};
}

}  // namespace

MarkDrawing::MarkDrawing(const sim::Model& model, int mark, render::Backend& backend)
    : m_model(&model),
      m_mark(&model.marks[std::size_t(mark)]),
      m_backend(&backend),
      m_material(painted(dye(m_mark->colour))) {
  if (FindingDrawing::draws(model, *m_mark))
    m_finding.emplace(model, *m_mark, backend);
  else if (!m_mark->is_stripe())
    make_disc();
}

void MarkDrawing::make_disc() {
  const double radius = m_mark->half, size = m_mark->label.size() > 1 ? kLabelBeside : kLabelHigh;
  constexpr double soft = 2.0 / kGrid;
  const auto number = [](int i, int j) { return std::uint32_t(j * (kGrid + 1) + i); };
  for (int j = 0; j <= kGrid; ++j)
    for (int i = 0; i <= kGrid; ++i) {
      const Vec3d p = in_disc(2.0 * i / kGrid - 1, 2.0 * j / kGrid - 1);
      const double out = length(p);
      const double rim = smooth(kRimFrom - soft, kRimFrom, out) * smooth(kRimTo + soft, kRimTo, out);
      const double ink = std::max(rim, ink_at(m_mark->label, p.x / size, p.y / size, 1.4 * soft / size));
      const double down = i == 0 || j == 0 || i == kGrid || j == kGrid ? kMarkBevel : 0;
      m_flat.push_back(vec_cast<float>(Vec3d{radius * p.x, radius * p.y, kMarkAbove - down}));
      m_buffer.add({}, Paint{235, 0, 0, to_byte(ink)});
    }
  for (int j = 0; j < kGrid; ++j)
    for (int i = 0; i < kGrid; ++i)
      m_buffer.quad(number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1));
  m_buffer.rest = m_flat;
}

void MarkDrawing::place_disc(const sim::MarkPose& pose) {
  if (m_there && length(pose.place - m_place) < kSeenToMove && length(pose.normal - m_normal) < 1e-3) return;
  m_place = pose.place;
  m_normal = pose.normal;
  const Vec3d aside = std::fabs(pose.normal.z) < 0.995 ? Vec3d{0, 0, 1} : Vec3d{0, 1, 0};
  const Vec3d right = normalised(cross(aside, pose.normal)), up = cross(pose.normal, right);
  for (std::size_t i = 0; i < m_flat.size(); ++i)
    m_buffer.positions[i] = vec_cast<float>(pose.place + double(m_flat[i].x) * right + double(m_flat[i].y) * up +
                                            double(m_flat[i].z) * pose.normal);
  render::vertex_normals(m_buffer.positions, m_buffer.indices, m_buffer.normals);
  if (m_there)
    m_mesh.move(m_buffer.positions, m_buffer.normals);
  else
    m_mesh = OwnedMesh(*m_backend, m_buffer.data());
  m_there = true;
}

void MarkDrawing::place_stripe(const TubeDrawing& tube) {
  if (m_version == tube.version()) return;
  m_version = tube.version();
  const std::vector<Vec3f> rings =
      tube.band(m_mark->s - m_mark->half, m_mark->s + m_mark->half, kMarkRings, kStripeLift);
  m_there = !rings.empty();
  if (!m_there) return;
  const auto sides = std::uint32_t(tube.sides());
  const bool fresh = m_buffer.size() == 0;
  if (fresh) {
    for (const Vec3f& p : rings) m_buffer.add(p, Paint{235, 0, 0, 0});
    for (std::uint32_t r = 0; r + 1 < std::uint32_t(kMarkRings); ++r)
      join_rows(m_buffer, r * sides, (r + 1) * sides, sides, true);
    m_buffer.rest = rings;
  }
  m_buffer.positions = rings;
  render::vertex_normals(m_buffer.positions, m_buffer.indices, m_buffer.normals);
  if (fresh)
    m_mesh = OwnedMesh(*m_backend, m_buffer.data());
  else
    m_mesh.move(m_buffer.positions, m_buffer.normals);
}

void MarkDrawing::update(const sim::State& state, std::span<const TubeDrawing> tubes) {
  if (m_finding) return m_finding->update(state);
  if (m_mark->is_stripe())
    place_stripe(tubes[std::size_t(m_mark->body())]);
  else
    place_disc(sim::pose_of(*m_model, state, *m_mark));
}

void MarkDrawing::list(std::size_t part, const Listing& to) const {
  if (m_finding) return m_finding->list(part, to);
  if (m_mark->colour == "none") return;
  if (!m_there) return;
  render::DrawItem drawn;
  drawn.mesh = m_mesh.handle();
  drawn.material = m_material;
  drawn.part = std::uint16_t(part);
  to.add(drawn);
}

}  // namespace trocar::view
