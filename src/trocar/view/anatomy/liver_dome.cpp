#include <algorithm>
#include <cmath>

#include <trocar/geometry/surfaces/point_grid.hpp>
#include <trocar/render/meshes/mesh_arrays.hpp>
#include <trocar/sim/model/bodies.hpp>
#include <trocar/view/anatomy/liver_dome.hpp>

namespace trocar::view {
namespace {

constexpr double kDomeWhole = 0.004, kNothing = 0.045;  // [m] from the body: goes all its way, none of it
constexpr float kTornOff = 0.02f;  // [m] what has moved much further has detached and is not followed

constexpr float kDomeCell = 0.006f;                 // [m] of the grid in which those places are found
constexpr float kCoarse = 0.004f, kRecess = 0.07f;  // [m] what shades the recess above it, and from how far
constexpr double kDomeDeepest = 0.85;

}  // namespace

LiverDome::LiverDome(const sim::Model& model, int organ, const LiverShape& shape, const WallSurface& wall,
                     render::Backend& backend)
    : m_model(&model), m_organ(organ), m_pose(tissue::make_pose(model.skin(organ))) {
  m_dome.shape = shape.dome(wall);
  m_falciform.shape = shape.falciform(wall);
  for (Part* part : {&m_dome, &m_falciform}) {
    part->rest = part->shape.positions;
    tie(*part);
    part->detail = Detail(levels_of(model, model.organ_name(organ)));
    coarsen(part->shape, part->detail, kBends);
    part->mesh = OwnedMesh(backend, part->shape.data());
  }
}

/// Each vertex to the three nearest places of the body's surface.
void LiverDome::tie(Part& part) const {
  std::vector<std::uint8_t> surface;
  for (int v = 0; v < skin().size(); ++v) surface.push_back(skin().at_surface(v) ? 1 : 0);
  const geometry::PointGrid grid(skin().rest, kDomeCell, surface);
  for (std::uint32_t i = 0; i < part.shape.size(); ++i) {
    Follow f;
    std::array<float, 3> far;
    for (float reach = grid.cell();; reach *= 2) {
      f = {i, {}, {}};
      far = {1e9f, 1e9f, 1e9f};
      grid.visit(part.rest[i], reach, [&](std::uint32_t v) {
        const Vec3f d = skin().rest[v] - part.rest[i];
        float d2 = dot(d, d);
        int on = int(v);
        for (std::size_t k = 0; k < 3; ++k)
          if (d2 < far[k]) std::swap(d2, far[k]), std::swap(on, f.on[k]);
      });
      if (far[2] <= reach * reach || reach > float(kNothing)) break;
    }
    const double share = smooth(kNothing, kDomeWhole, std::sqrt(double(far[0])));
    if (!(share > 0)) continue;
    float sum = 0;
    for (std::size_t k = 0; k < 3; ++k) sum += f.share[k] = 1 / (far[k] + 1e-7f);
    for (float& s : f.share) s *= float(share) / sum;
    part.follows.push_back(f);
  }
}

void LiverDome::move(Part& part) {
  for (const Follow& f : part.follows) {
    Vec3f way{};
    for (std::size_t k = 0; k < 3; ++k) way += f.share[k] * m_way[std::size_t(f.on[k])];
    part.shape.positions[f.vertex] = part.rest[f.vertex] + way;
  }
  render::vertex_normals(part.shape.positions, part.shape.indices, part.shape.normals);
  part.mesh.move(part.shape.positions, part.shape.normals);
}

void LiverDome::shade(const render::OpennessBaker& baker) {
  for (Part* part : {&m_dome, &m_falciform}) {
    const std::vector<Paint> own = part->shape.paint;  // where it runs out into nothing
    baker.bake(part->shape.positions, part->shape.normals, part->shape.paint);
    render::even_openness(part->shape.indices, part->shape.paint, 6);
    for (std::size_t i = 0; i < own.size(); ++i)
      part->shape.paint[i].openness = std::uint8_t(part->shape.paint[i].openness * own[i].openness / 255);
    part->mesh.update(part->shape);
  }
}

void LiverDome::shade_behind(std::span<const Vec3f> positions, std::span<const Vec3f> normals,
                             std::span<Paint> paint) const {
  const render::OpennessBaker baker({{{m_dome.shape.positions, m_dome.shape.indices}}}, kCoarse, kRecess);
  std::vector<Paint> deep(positions.size());
  baker.bake(positions, normals, deep);
  for (std::size_t i = 0; i < deep.size(); ++i)
    paint[i].openness = std::uint8_t(paint[i].openness * (1 - kDomeDeepest + kDomeDeepest * deep[i].openness / 255.0));
}

void LiverDome::update(const sim::State& state) {
  const auto follow = [&](const auto& body, const auto& now) {
    if (!m_moved(now.nodes)) return;
    tissue::pose_skin(view_of(body, now), skin(), m_pose);
    m_way.resize(m_pose.position.size());
    for (std::size_t v = 0; v < m_way.size(); ++v) {
      const Vec3f way = m_pose.position[v] - skin().rest[v];
      const float far = dot(way, way) / (kTornOff * kTornOff);
      m_way[v] = (1 / (1 + far * far)) * way;
    }
    move(m_dome);
    move(m_falciform);
  };
  sim::visit_organ(
      *m_model, std::size_t(m_organ),
      sim::Overloaded{[&](sim::SolidRef r) { follow(model_of(*m_model, r).network, state.solids[r.index]); },
                      [&](sim::CuttableRef r) { follow(model_of(*m_model, r).body, state.cuttables[r.index]); }});
}

void LiverDome::list(std::size_t part, const Listing& to) {
  render::DrawItem dome = item(m_dome.mesh.handle(), look(*m_model, m_model->organ_look(m_organ)), part);
  dome.material.two_sided = true;
  to.add(dome, m_dome.detail, m_dome.shape.positions);
  to.add(item(m_falciform.mesh.handle(), look(*m_model, "falciform"), part), m_falciform.detail,
         m_falciform.shape.positions);
}

}  // namespace trocar::view
