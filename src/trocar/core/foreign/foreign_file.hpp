// Files of other kinds that are given where Trocar wants one of its own: they are named, so that a fault says what to
// do instead.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace trocar::core {

/// What a reader wants.
enum class Wanted : unsigned char { json, mesh, volume };

/// What a file is that begins with `bytes` (its first 64 KiB are enough), and what to do instead: "a ZIP archive:
/// unpack it ...". Empty: nothing that is known, or it may be what is wanted.
/// @param file  its name, whose ending says what bytes do not: many formats begin as any text, HDF5 or ZIP does
std::string foreign_file(std::string_view bytes, Wanted wanted, std::string_view file = {});

/// The same of a file on the disk; empty, too, where it cannot be read.
std::string foreign_file_at(const std::filesystem::path& path, Wanted wanted);

/// The same of XML with such a root: "SDFormat (<sdf>): ...".
std::string foreign_xml(std::string_view root, Wanted wanted);

}  // namespace trocar::core
