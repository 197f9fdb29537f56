// A room's model as it is drawn.
#pragma once

#include <trocar/studies/operating_room/room_model.hpp>
#include <trocar/view/operating_room/room_drawing.hpp>

namespace trocar::app {

/// What stands there at this pose. It refers to model and pose, which must outlive its use.
view::Scenery scenery_of(const studies::RoomModel& model, const studies::RoomPose& pose);

/// Lines between the nearest pairs, as far as they are nearer than `within` [m].
void show_clearance(view::Scenery& scenery, const studies::RoomModel& model, const studies::RoomPose& pose,
                    double within);
/// Where the shafts of arms and instruments can point: their ports' cones [g: 60 degrees about the skin's normal].
void show_reach(view::Scenery& scenery, const studies::RoomModel& model);

}  // namespace trocar::app
