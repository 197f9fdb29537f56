// Meshes of what is in an operating room. Private to the folder.
#pragma once

#include <trocar/view/operating_room/room_drawing.hpp>

namespace trocar::view::room {

using namespace painted;
using painted::Colour;

/// Cloth over patient and table, with a window over the abdomen and a screen before the head. In the patient's frame.
MeshBuffer drape_mesh(const Scenery& s);
/// The skin in the window, painted by heat where there is some.
MeshBuffer skin_mesh(const Scenery& s);
/// Head and pillow.
MeshBuffer head_mesh(const Scenery& s);
MeshBuffer table_mesh(const Scenery& s);         ///< top and cushions, in the patient's frame
MeshBuffer table_column_mesh(const Scenery& s);  ///< in the room
MeshBuffer person_mesh(const Scenery::Person& p, double floor);
MeshBuffer floor_mesh(const Scenery& s);  ///< unlit, with soft shadows of what stands on it
MeshBuffer monitor_mesh(const Scenery::Monitor& m, double floor);
MeshBuffer port_mesh(const Scenery::Port& p);
MeshBuffer handle_mesh(const Scenery::Instrument& i);

}  // namespace trocar::view::room
