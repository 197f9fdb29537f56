// What a document lacks to be operated on, each with the steps that mend it: the organ is attached, the endoscope sees
// it, its size is plausible, its tissue and material are known, its surface is closed.
//
//   for (const Finding& f : readiness(document, description, faults)) show(f.words, f.remedy);
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <trocar/core/error.hpp>
#include <trocar/geometry/surfaces/tri_mesh.hpp>
#include <trocar/modeller/document/document.hpp>
#include <trocar/scene/description/description.hpp>

namespace trocar::modeller {

inline constexpr double kLeastOrgan = 1e-7, kMostOrgan = 0.02;  ///< [m^3] 0.1 mL .. 20 L: our estimate

struct Finding {
  enum class About { organ, attachment, view, size, tissue, material, surface, file };
  About about;
  std::string thing;                    ///< "solid:liver"; empty: the document
  std::string words;                    ///< a sentence for the user
  std::string remedy;                   ///< words of a button; empty: nothing mends it with one click
  std::vector<scene::JsonValue> steps;  ///< operations that the remedy does; none where the user chooses from a list
};

/// Empty: it can be operated on.
/// @param description  what could be read of it; none where nothing could
std::vector<Finding> readiness(const Document& document, const scene::Description* description,
                               const std::vector<core::Fault>& faults);

/// A ball that holds a body where it is thick: about the middle, or about the place of its surface nearest to that.
scene::Anchor hold_in_middle(const geometry::TriMesh& mesh, double cell);
scene::Anchor middle_hold(const scene::Solid& solid);
scene::Anchor middle_hold(const scene::Pouch& pouch);
bool is_attached(const scene::Solid& solid);
bool is_attached(const scene::Pouch& pouch);

/// Where the middle of a body of that size goes so that the endoscope sees it and no instrument starts in it [m]. None
/// without an endoscope.
std::optional<Vec3d> place_in_view(const scene::Description& description, Vec3d size);
/// By which a body of that longest side becomes as large as an organ; 1 where it is.
double scale_to_organ(double longest);

}  // namespace trocar::modeller
