// Whole files, as bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>

namespace trocar::core {

/// Throws BadInput (path:0:0) where there is no file, no more than a folder, more than `most` bytes, or none to be had.
std::string read_file(const std::filesystem::path& path, std::uint64_t most);

/// Puts the parts, one after the other, into a file at once and for good: written beside it under a name that no other
/// program has, flushed to the disk, then renamed, so that an interrupted write leaves the old one. No link is
/// followed: one of that name is replaced by the file. Files that ended programs left unfinished beside it go.
/// @param mode  of a new file; one that is there keeps its own
/// @return empty, or what the system says is wrong
std::string write_file(const std::filesystem::path& path, std::initializer_list<std::string_view> parts,
                       unsigned mode = 0644);
std::string write_file(const std::filesystem::path& path, const void* bytes, std::size_t size, unsigned mode = 0644);

/// The same in a folder that is made where it is missing. @throws BadInput (path:0:0)
void put_file(const std::filesystem::path& path, std::string_view bytes);

/// A name beside a file for what is not whole yet, which no other program and no other thread has:
/// NAME.PROCESS-NUMBER.part
std::filesystem::path unfinished_name(const std::filesystem::path& path);
/// Removes files of such names whose programs have ended from a folder, ten minutes after their last byte.
/// @param name  of the file that was to be written; empty: any
void remove_unfinished(const std::filesystem::path& folder, const std::string& name = {});

}  // namespace trocar::core
