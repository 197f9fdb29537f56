#include <algorithm>

#include <trocar/attempt/solver_beside.hpp>
#include <trocar/core/error.hpp>
#include <trocar/scene/json/shape.hpp>
#include <trocar/sim/model/bodies.hpp>

namespace trocar::attempt {
namespace {

const tissue::Skin& drawn_skin(const sim::Model& model, int organ) {
  const std::int32_t lattice = sim::lattice_of(model, organ);
  return lattice >= 0 ? model.solids[std::size_t(lattice)].fine : model.skin(organ);
}

}  // namespace

std::vector<std::string> organ_names(const scene::Description& scene) {
  std::vector<std::string> names;
  for (const scene::Solid& s : scene.solids) names.push_back(s.name);
  return names;
}

void set_solver(scene::Description& scene, const std::string& organ, scene::Solver solver, const std::string& asked) {
  const auto named = [&organ](const scene::Solid& s) { return s.name == organ; };
  const auto found = std::find_if(scene.solids.begin(), scene.solids.end(), named);
  if (found == scene.solids.end())
    throw core::BadInput({{{asked, 0, 0}, scene::unknown_name("organ", organ, organ_names(scene))}});
  found->solver = solver;
  if (found->solver_at.file.empty()) found->solver_at = found->at;  // its file says nothing of a solver: faults, here
}

OrganSkin::OrganSkin(const sim::Model& model, int organ, Which which)
    : m_model(&model),
      m_organ(organ),
      m_skin(which == Which::drawn ? &drawn_skin(model, organ) : &model.skin(organ)),
      m_pose(tissue::make_pose(*m_skin)) {
  m_pose.position = m_skin->rest;
}

const std::vector<Vec3f>& OrganSkin::at(const sim::State& state) {
  tissue::pose_skin(nodes_of(*m_model, state, m_organ), *m_skin, m_pose);
  return m_pose.position;
}

std::unique_ptr<Lesson> load_beside(const std::string& exercise, std::uint64_t seed, const std::string& organ,
                                    const std::string& asked) {
  return load_adapted(exercise, seed, [&](scene::Description& scene) {
    for (const scene::Solid& s : scene.solids)
      if (s.name == organ)
        return set_solver(scene, organ,
                          s.is_quasi_static() ? scene::Solver::dynamic_network : scene::Solver::elastostatic, asked);
    set_solver(scene, organ, scene::Solver::elastostatic, asked);  // reports what organs there are
  });
}

SolverBeside::SolverBeside(const sim::Model& model, int organ, int threads)
    : m_model(model),
      m_pool(threads),
      m_state(sim::initial_state(model)),
      m_work(sim::make_work(model, &m_pool)),
      m_organ(organ),
      m_skin(model, organ),
      m_outline(model, organ, OrganSkin::Which::touched) {}

void SolverBeside::advance(const sim::Input& input) { m_flags |= sim::step(m_model, input, m_state, m_work).flags; }

}  // namespace trocar::attempt
