// Which of the stacks of a folder is read, and which of several images at each position. Used by the readers only.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <trocar/volumes/files/dicom_folder.hpp>
#include <trocar/volumes/files/dicom_stacks.hpp>

namespace trocar::volumes {

/// The index of a stack. What there is goes into the report, with a note where there are several.
/// @param file    of the folder's files: it was named; -1: none was
/// @throws SeriesChoice  where the default is one of several parts of a series or a file
/// @throws core::BadInput  for a series that there is none of, or that is damaged or no volume
std::size_t choose_stack(const DicomFolder& folder, const std::vector<DicomStack>& stacks, int file,
                         const std::string& name, const ReadOptions& options, ReadReport& report);

/// The index of a group. The default is that of the file, else the first.
int choose_group(const DicomStack& stack, int file, const std::string& name, const ReadOptions& options,
                 ReadReport& report);

/// Slices of the same series that lie among those of the stack and differ from them: where slices are missing, these
/// are why.
std::vector<core::Fault> faults_of_set_aside(const std::vector<DicomStack>& stacks, const DicomStack& chosen,
                                             const std::vector<DicomHeader>& files);

}  // namespace trocar::volumes
