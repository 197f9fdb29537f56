// The same scene once more beside an attempt, with the other solver for one of its organs: what dynamic and static make
// of the same hands, tick by tick.
//
//   const auto other = load_beside(exercise, seed, "bladder");
//   SolverBeside beside(other->model, other->model.organ_index("bladder"));
//   for (...) sim::step(model, input, state, work), beside.advance(input);
//   OrganSkin(model, organ).at(state), beside.skin()        // where both skins are
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <trocar/attempt/lesson.hpp>
#include <trocar/core/parallel.hpp>
#include <trocar/tissue/network/skin.hpp>

namespace trocar::attempt {

/// Another solver for an organ than its file says, before the scene is compiled.
/// @param asked  what named the organ, for faults: an option
/// @throws core::BadInput with what there is, where there is no such organ
void set_solver(scene::Description& scene, const std::string& organ, scene::Solver solver,
                const std::string& asked = "--organ");
std::vector<std::string> organ_names(const scene::Description& scene);

/// Where a skin of an organ is, the drawn one or the coarser one that is touched. Vertices of what a cut adds are left
/// out: they have no counterpart.
class OrganSkin {
 public:
  enum class Which { drawn, touched };
  /// `model` must outlive it.
  OrganSkin(const sim::Model& model, int organ, Which which = Which::drawn);
  /// (vertices) [m]; those that are not at the surface stay in the drawn shape.
  const std::vector<Vec3f>& at(const sim::State& state);
  const tissue::Skin& skin() const { return *m_skin; }

 private:
  const sim::Model* m_model;
  int m_organ;
  const tissue::Skin* m_skin;
  tissue::SkinPose m_pose;
};

/// The exercise with the other solver for that organ than its file says.
/// @throws core::BadInput as load_lesson(), and where there is no such organ; the fault is at `asked`
std::unique_ptr<Lesson> load_beside(const std::string& exercise, std::uint64_t seed, const std::string& organ,
                                    const std::string& asked = "--organ");

class SolverBeside {
 public:
  /// `model` must outlive it.
  SolverBeside(const sim::Model& model, int organ, int threads = core::default_thread_count());

  /// One tick with the hands that the other one gets.
  void advance(const sim::Input& input);

  const sim::Model& model() const { return m_model; }
  const sim::State& state() const { return m_state; }
  int organ() const { return m_organ; }
  const std::vector<Vec3f>& skin() { return m_skin.at(m_state); }        ///< (vertices) [m]
  const std::vector<Vec3f>& outline() { return m_outline.at(m_state); }  ///< (vertices of what is touched) [m]
  std::uint32_t flags() const { return m_flags; }                        ///< of all ticks so far

 private:
  const sim::Model& m_model;
  core::ThreadPool m_pool;
  sim::State m_state;
  sim::Work m_work;
  int m_organ;
  OrganSkin m_skin, m_outline;
  std::uint32_t m_flags = 0;
};

}  // namespace trocar::attempt
