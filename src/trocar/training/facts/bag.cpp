#include <trocar/interactions/objects/bag_contents.hpp>
#include <trocar/training/facts/needs.hpp>
#include <trocar/training/facts/registry.hpp>

namespace trocar::training {
namespace {

using interactions::Bag;

const interactions::BagState& the_bag(const Snapshot& snapshot) {
  return interactions::part_of<Bag>(snapshot.state).front();
}

Value held(const Snapshot& snapshot, const Arguments& a) {
  const interactions::BagModel& model = interactions::part_of<Bag>(snapshot.model).list.front();
  const interactions::BagShare share = share_in(model, the_bag(snapshot), a[0].body());
  return share.all > 0 ? Value(double(share.inside) / share.all) : kUnknown;
}
Value mouth(const Snapshot& snapshot, const Arguments&) { return the_bag(snapshot).hoop; }
Value shut(const Snapshot& snapshot, const Arguments&) { return the_bag(snapshot).shut(); }
Value out(const Snapshot& snapshot, const Arguments&) { return the_bag(snapshot).out != 0; }

std::string_view needs_bag(const sim::Model& model) {
  return interactions::part_of<Bag>(model).list.empty() ? "a bag" : "";
}

/// A body that can be in a bag at all.
std::string refuses_body(const sim::Model&, const Arguments& a) {
  if (a[0].body().is(BodyKind::rigid) || a[0].body().is(BodyKind::membrane)) return {};
  return "expected a rigid object or a pouch, got something that cannot be put into a bag";
}

}  // namespace

const Fact kBagHolds{"bag.holds_share",
                     {{"of", ArgumentKind::body, "a rigid object or a pouch"}},
                     0,
                     1,
                     "The share of the object that has entered the bag through its mouth; 0 or 1 for a rigid object.",
                     needs_bag,
                     &stateless<held>,
                     false,
                     &refuses_body};
const Fact kBagMouth{"bag.mouth_share",
                     {},
                     0,
                     1,
                     "Share of the bag's hoop that is out of its sleeve: 1 when the bag is open.",
                     needs_bag,
                     &stateless<mouth>};
const Fact kBagShut{"bag.closed",     {},  0, 1, "The bag has been opened, and its mouth is closed.", needs_bag,
                    &stateless<shut>, true};
const Fact kBagOut{"bag.out",
                   {},
                   0,
                   1,
                   "The closed bag's neck has been drawn into the trocar; its contents count as removed.",
                   needs_bag,
                   &stateless<out>,
                   true};

}  // namespace trocar::training
