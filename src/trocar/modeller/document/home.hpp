// Where a document is looked at: a scene is its own home; an organ alone is put into the modelling place, a scene with
// ports, instruments and light and nothing else.
#pragma once

#include <trocar/modeller/document/document.hpp>

namespace trocar::modeller {

/// The scene file to read for the document; for an organ its text is put into `memory`.
/// @throws core::BadInput for a file of another kind
fs::path at_home(const Document& document, scene::MemoryFiles& memory);

/// A scene in the place to model in with an organ's file.
std::string text_of_place_with(const std::string& organ_file, const std::string& title);

/// scenes/modelling/place.json. @throws core::BadInput where the program's scenes are not there
fs::path modelling_place();

/// A document that is on no disk yet: a scene in the modelling place, or an organ alone.
/// @param wanted  its name; what names cannot hold becomes _
Document begun(const fs::path& file, bool organ, const std::string& wanted);

/// The text with the names of files that stand in it as they are from another folder.
/// @param root  what the text says
std::string renamed_from(const std::string& text, const scene::JsonValue& root, const fs::path& from,
                         const fs::path& to);

/// The same for the value of one of a file's keys.
scene::JsonValue renamed_value(const std::string& key, const scene::JsonValue& value, const fs::path& from,
                               const fs::path& to);

/// Where a name in a file of `folder` leads: there, else into the installed folder `scenes`.
fs::path named_file(const Document& document, const fs::path& folder, const std::string& name);

/// Keys under which files name others.
bool names_files(std::string_view key);

}  // namespace trocar::modeller
