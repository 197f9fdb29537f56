// What the pictures of a scene's gallery are called, before any is drawn: a name that none of them has is told at once
// instead of after every scene has been drawn for nothing.
#pragma once

#include <string>
#include <vector>

#include <trocar/scene/description/description.hpp>

namespace trocar::app {

/// Names of all pictures that `scene` may have; of some only drawing shows whether there are any (a bleeding needs a
/// vessel that can bleed).
std::vector<std::string> gallery_names(const scene::Description& scene);

/// Does one of the scenes' pictures have `part` in its name? Otherwise core::BadInput with the nearest name.
void check_picture_name(const std::string& part, const std::vector<scene::Description>& scenes);

}  // namespace trocar::app
