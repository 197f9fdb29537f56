// A document to begin with: an organ in the place to model in, attached and in the endoscope's view.
#pragma once

#include <trocar/modeller/document/document.hpp>

namespace trocar::modeller {

/// An ellipsoid of 50 mm, called "organ". It is on no disk yet, and has no history.
Document first_organ(const fs::path& file, const std::string& title);

}  // namespace trocar::modeller
