#include "guide/refusals.hpp"

#include <trocar/attempt/hand_names.hpp>
#include <trocar/core/text.hpp>

namespace trocar::app {
namespace {

using devices::Button;
using devices::Key;

/// What was asked for, by whatever device.
struct Asked {
  const devices::HandSample& sample;
  const devices::Gamepad& before;
  bool key(std::initializer_list<Key> keys) const {
    for (const Key k : keys)
      if (sample.pressed.has(k)) return true;
    return false;
  }
  bool button(Button b) const { return sample.gamepad.has(b) && !before.has(b); }
  bool both_shoulders() const {
    return sample.gamepad.has(Button::left_shoulder) && sample.gamepad.has(Button::right_shoulder);
  }
};

class Refusal {
 public:
  Refusal(const KeySituation& situation, const Asked& asked) : s(situation), m_asked(asked) {}

  std::string of(bool layout) const {
    if (layout && s.scored) return tr("The layout cannot change while the exercise is scored.");
    for (const auto& why : {choosing(), closing(), viewing(), rack(), verbs(), endoscope(), wrist()})
      if (!why.empty()) return why;
    return {};
  }

 private:
  int hands() const { return attempt::hand_count(s.model); }
  bool scope() const { return s.led == devices::kScope; }
  std::string label(const char* name) const { return core::key_label(name, s.device); }
  std::string only_endoscope() const { return tr("This exercise has the endoscope only."); }

  std::string choosing() const {
    constexpr Key kNumbers[] = {Key::one, Key::two, Key::three, Key::four};
    for (int i = hands(); i < 4; ++i)
      if (m_asked.key({kNumbers[i]}))
        return hands() == 0 ? only_endoscope() : tr("There is no instrument {} here.", i + 1);
    if (hands() == 0 && m_asked.key({Key::tab})) return only_endoscope();
    const bool mode = m_asked.key({Key::h}) || (m_asked.both_shoulders() && m_asked.button(Button::y));
    if (mode && hands() < 2) return tr("Both hands at once need two instruments. This exercise has {}.", hands());
    return {};
  }

  std::string closing() const {
    const bool jaws = m_asked.key({Key::g, Key::enter, Key::space});
    if (!jaws || !scope()) return {};
    return hands() == 0 ? only_endoscope()
                        : tr("The endoscope has no jaws. Choose an instrument: {}.", label("instrument"));
  }

  std::string viewing() const {
    if (!m_asked.key({Key::v}) && !(m_asked.button(Button::x) && !m_asked.both_shoulders())) return {};
    if (hands() == 0) return only_endoscope();
    if (scope()) return tr("Choose the instrument to bring into view first: {}.", label("instrument"));
    return s.seen ? tr("This instrument is already in view.") : std::string();
  }

  std::string rack() const {
    if (!m_asked.key({Key::x}) && !(m_asked.button(Button::y) && !m_asked.both_shoulders())) return {};
    if (hands() == 0) return only_endoscope();
    if (scope() || attempt::choosable(s.model, s.state, s.led).size() > 1) return {};
    return tr("There is no other instrument for this trocar.");
  }

  std::string verbs() const {
    const bool declare = m_asked.key({Key::k}) || (m_asked.both_shoulders() && m_asked.button(Button::b));
    if (declare && !s.declares) return tr("Nothing has to be declared in this exercise.");
    if (m_asked.key({Key::b, Key::n}) && !s.model.energy.there) return tr("This exercise has no electrosurgery.");
    if (m_asked.key({Key::a, Key::d}) && (scope() || !attempt::has_valves(s.model, s.state, s.led)))
      return tr("Suction and water need a suction-irrigator. Plungers need an injection needle.");
    if (m_asked.key({Key::t}) && attempt::lens_in_words(s.model, s.state).empty()) return tr("The lens is clear.");
    return {};
  }

  std::string endoscope() const {
    if (!m_asked.key({Key::r, Key::f})) return {};
    if (s.model.scope.angle == 0) return tr("A straight endoscope has no light post to turn.");
    return scope() ? std::string()
                   : tr("The light post belongs to the endoscope. Control it first: {}.", label("endoscope"));
  }

  std::string wrist() const {
    if (!m_asked.key({Key::i, Key::m, Key::j, Key::l, Key::o})) return {};
    if (!scope() && s.model.tool(s.state, std::size_t(s.led)).bends.bends()) return {};
    return tr("What you control has no wrist.");
  }

  const KeySituation& s;
  const Asked& m_asked;
};

}  // namespace

std::string refusal(const KeySituation& situation, const devices::HandSample& sample, const devices::Gamepad& before,
                    bool layout) {
  return Refusal(situation, {sample, before}).of(layout);
}

}  // namespace trocar::app
