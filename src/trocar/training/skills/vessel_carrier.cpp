#include <trocar/training/skills/vessel_carrier.hpp>

namespace trocar::training {
namespace {

VesselCarrier on_strand(Surgeon& op, int strand, interactions::StrandPlace place) {
  const interactions::StrandBody& body = op.model().strand_bodies[size_t(strand)];
  const tissue::StrandState& state = op.state().strands[size_t(strand)];
  return {interactions::point_at(body, state, place), interactions::tangent_at(body, state, place),
          body.model.radius[size_t(place.element)]};
}

}  // namespace

VesselCarrier carrier_at(Surgeon& op, int vessel, double s) {
  const interactions::VesselSpot at = op.vessel_spot(vessel, s);
  const interactions::VesselPoint& point = op.model().vessels.list[size_t(vessel)].path.points[size_t(at.after)];
  const interactions::VesselHold& hold = point.hold;
  if (hold.kind != interactions::VesselHold::strand) return {at.place, at.along, point.radius};
  // The point before the place: what is left lies along the strand.
  const interactions::StrandBody& body = op.model().strand_bodies[size_t(hold.index)];
  const VesselCarrier before = on_strand(op, hold.index, {hold.element, hold.w});
  const double ahead = dot(at.place - before.place, before.along);
  return on_strand(op, hold.index,
                   interactions::place_at(body, interactions::arc_at(body, {hold.element, hold.w}) + ahead));
}

}  // namespace trocar::training
