#include "guide/equipment.hpp"

namespace trocar::app {

bool Equipment::has(devices::HelpNeeds needs) const {
  using Needs = devices::HelpNeeds;
  switch (needs) {
    case Needs::nothing:
      return true;
    case Needs::instrument:
      return hands > 0;
    case Needs::two_instruments:
      return hands > 1;
    case Needs::jaws:
      return jaws;
    case Needs::clips:
      return clips;
    case Needs::valves:
      return valves;
    case Needs::needle:
      return needle;
    case Needs::hook:
      return hook;
    case Needs::energy:
      return energy;
    case Needs::wrist:
      return wrist;
    case Needs::oblique:
      return oblique;
    case Needs::lens:
      return lens;
    case Needs::declares:
      return declares;
  }
  return true;
}

Equipment equipment_of(const sim::Model& model, bool declares) {
  Equipment e{int(model.hands.size()), false, false, false, false, false, false, false, false, false, declares};
  for (const sim::HandModel& hand : model.hands)
    for (const interactions::ToolModel& tool : hand.rack) {
      const interactions::Abilities& can = tool.can();
      e.jaws |= can.grip || can.cut || can.set_clips || can.sling;
      e.clips |= can.set_clips;
      e.valves |= can.irrigate;
      e.needle |= can.inject;
      e.hook |= can.coagulate && !can.grip;
      e.energy |= can.coagulate;
      e.wrist |= tool.bends.bends();
    }
  e.energy &= model.energy.there;
  e.oblique = model.scope.angle != 0;
  e.lens = model.wet.there;
  return e;
}

}  // namespace trocar::app
