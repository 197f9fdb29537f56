// A small drawing of what is controlled: the endoscope, or an instrument by what its tip can do.
#pragma once

#include <imgui.h>

#include <trocar/interactions/instrument/tool_kind.hpp>

namespace trocar::app {

/// @param at  upper left corner  @param size  width and height [px]
void draw_instrument_icon(ImDrawList& draw, const interactions::Abilities& can, ImVec2 at, ImVec2 size, ImU32 colour);
void draw_endoscope_icon(ImDrawList& draw, ImVec2 at, ImVec2 size, ImU32 colour);

}  // namespace trocar::app
