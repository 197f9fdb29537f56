#include "guide/key_lines.hpp"

#include <trocar/attempt/hand_names.hpp>
#include <trocar/core/text.hpp>
#include <trocar/devices/mouse_keyboard.hpp>

namespace trocar::app {
namespace {

class KeyLines {
 public:
  explicit KeyLines(const KeyQuestion& question) : q(question) {}

  std::vector<std::string> lines() {
    who();
    const training::StepNeeds& n = q.needs;
    if (n.energy && !named("pedal_coagulate") && !named("pedal_cut"))
      add(tr("Foot switches: {} coagulates, {} cuts.", key("pedal_coagulate"), key("pedal_cut")));
    if (n.declare && !named("declare")) add(tr("Declare: {}.", key("declare")));
    if (n.inject && !named("plunger_press"))
      add(tr("Plunger: {} presses, {} draws.", key("plunger_press"), key("plunger_draw")));
    if (n.suction && !named("suction")) add(tr("Suction: {}. Water: {}.", key("suction"), key("water")));
    if (n.clip && !named("grasp")) add(tr("Close slowly: {} with {}.", key("grasp"), key("fine")));
    if (n.divide && !named("grasp")) add(tr("Cut: {}.", key("grasp")));
    if (n.grasp && !named("grasp")) add(tr("Grasp: {}. Lock the jaws: {}.", key("grasp"), key("lock")));
    return m_lines;
  }

 private:
  std::string key(const char* name) const { return core::key_label(name, q.device); }
  bool named(const char* name) const { return q.hint.find(std::string("{key:") + name + "}") != std::string::npos; }
  void add(std::string line) { m_lines.push_back(std::move(line)); }

  /// Whether the right one is controlled, and how it moves.
  void who() {
    if (q.led == kNobody) return;
    const bool scope = q.led == devices::kScope;
    if (q.needs.endoscope) {
      if (!scope && !named("endoscope")) add(tr("Endoscope: {}, then {}.", key("endoscope"), key("move")));
      if (scope && !named("move"))
        add(tr("Endoscope: {} turns, {} moves along it, {} rolls.", key("move"), key("depth"), key("roll")));
      if (scope && q.model.scope.angle != 0 && !named("light_post"))
        add(tr("Look around corners (light post): {}.", key("light_post")));
    } else if (q.needs.hand >= 0 && q.led != q.needs.hand) {
      add(tr("Control {}: {}.", attempt::hand_name(q.model, q.needs.hand), hand_key(q.needs.hand, q.device)));
    }
  }

  const KeyQuestion& q;
  std::vector<std::string> m_lines;
};

}  // namespace

std::vector<std::string> key_lines(const KeyQuestion& question) { return KeyLines(question).lines(); }

std::string hand_key(int hand, core::KeyDevice device) {
  return device == core::KeyDevice::mouse_and_keys ? std::to_string(hand + 1) : core::key_label("instrument", device);
}

}  // namespace trocar::app
