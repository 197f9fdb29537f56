#include <trocar/interactions/objects/bag_contents.hpp>
#include <trocar/training/facts/needs.hpp>
#include <trocar/training/facts/registry.hpp>

namespace trocar::training {
namespace {

using interactions::Bag;

const interactions::BagState& the_bag(const Moment& moment) {
  return interactions::part_of<Bag>(moment.state.objects).front();
}

Value held(const Moment& moment, const Arguments& a) {
  const interactions::BagModel& model = interactions::part_of<Bag>(moment.model.objects).list.front();
  const interactions::BagShare share = share_in(model, the_bag(moment), a[0].body());
  return share.all > 0 ? Value(double(share.inside) / share.all) : kUnknown;
}
Value mouth(const Moment& moment, const Arguments&) { return the_bag(moment).hoop; }
Value shut(const Moment& moment, const Arguments&) { return the_bag(moment).shut(); }
Value out(const Moment& moment, const Arguments&) { return the_bag(moment).out != 0; }

std::string_view needs_bag(const sim::Model& model) {
  return interactions::part_of<Bag>(model.objects).list.empty() ? "a bag" : "";
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
