#include <algorithm>

#include <trocar/training/exercise/guide.hpp>
#include <trocar/training/exercise/rules.hpp>

namespace trocar::training {

const std::string* Guide::owner(BodyId body) const {
  for (const Owner& o : m_owners)
    if (o.body == body) return &o.name;
  return nullptr;
}

const std::string* Guide::work_on(BodyId body) {
  for (const Owner& o : m_owners)
    if (o.body == body) {
      turn_to(o.set, o.element);
      return &o.name;
    }
  return nullptr;
}

void Guide::step_done(int step) {
  for (const Block& b : m_blocks)
    if (!b.set.empty() && step >= b.first && step < b.first + b.steps * b.elements)
      turn_to(b.set, (step - b.first) / b.steps);
}

int Guide::focus(const std::string& set) const {
  for (const Focus& f : m_focus)
    if (f.set == set) return f.element;
  return 0;
}

void Guide::turn_to(const std::string& set, int element) {
  for (Focus& f : m_focus)
    if (f.set == set) {
      f.element = element;
      return;
    }
  m_focus.push_back({set, element});
}

int Guide::current(const Rules& rules, const Scoreboard& board) const {
  int any = int(board.steps().size());
  const auto look_for = [&](bool needed, bool allowed) {
    for (const Block& b : m_blocks)
      for (int k = 0; k < b.elements; ++k) {
        const int element = (focus(b.set) + k) % b.elements;
        for (int i = b.first + element * b.steps, n = 0; n < b.steps; ++n, ++i)
          if (board.open(i) && (!needed || !board.step(i).optional) && (!allowed || rules.allowed(i))) return i;
      }
    return any;
  };
  // Those that can be done now first; optional ones when nothing else is left.
  for (const auto& [needed, allowed] : {std::pair(true, true), {true, false}, {false, true}})
    if (const int i = look_for(needed, allowed); i != any) return i;
  return any;
}

}  // namespace trocar::training
