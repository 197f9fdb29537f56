#include <map>

#include <fmt/format.h>

#include <trocar/core/memory.hpp>
#include <trocar/modeller/drive/body_memory.hpp>
#include <trocar/sim/model/bodies.hpp>

namespace trocar::modeller {
namespace {

class Counting {
 public:
  explicit Counting(const sim::Model& model) : m_model(model), m_state(sim::drawn_bodies(model)) {}

  std::map<std::string, std::size_t> all() {
    sim::visit_bodies(m_model, [this](auto body) { count(body); });
    for (const sim::StaticOrgan& o : m_model.statics) add(m_model.organ_name(o.organ), o);
    for (std::size_t i = 0; i < m_state.statics.size(); ++i)
      add(m_model.organ_name(m_model.statics[i].organ), m_state.statics[i]);
    for (const sim::WallModel& wall : m_model.walls) add(wall.name, wall);
    for (std::size_t i = 0; i < m_model.fat.size(); ++i) add(m_model.fat[i].name, m_model.fat[i], m_state.fat[i]);
    return m_bytes;
  }

 private:
  template <class... Parts>
  void add(const std::string& name, const Parts&... parts) {
    m_bytes[name] += (core::memory_of(parts) + ...);
  }
  template <class Ref>
  void count(Ref r) {
    add(model_of(m_model, r).name, model_of(m_model, r), state_of(m_state, r));
  }
  void count(sim::StrandRef r) {
    add(model_of(m_model, r).name, model_of(m_model, r), rod_of(m_model, r), state_of(m_state, r));
  }

  const sim::Model& m_model;
  sim::State m_state;
  std::map<std::string, std::size_t> m_bytes;
};

}  // namespace

std::vector<std::size_t> memory_of_bodies(const sim::Model& model, const scene::CompileReport& report) {
  const std::map<std::string, std::size_t> bytes = Counting(model).all();
  std::vector<std::size_t> out;
  for (const scene::BodyReport& b : report.bodies) {
    const auto found = bytes.find(b.name);
    // a tree's report goes by its first vessel's name; `start` is its part of a State
    out.push_back(b.kind == "vessels" ? core::memory_of(model.vessels) : found == bytes.end() ? 0 : found->second);
  }
  return out;
}

std::string memory_in_words(std::size_t bytes) {
  const double kB = 1e-3 * double(bytes);
  return kB < 999.5 ? fmt::format("{:.0f} kB", kB) : fmt::format("{:.1f} MB", 1e-3 * kB);
}

}  // namespace trocar::modeller
