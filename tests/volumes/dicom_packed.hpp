// A DICOM file in another transfer syntax, by GDCM; for tests and seeds of the fuzzer. Empty without GDCM.
#pragma once

#include <string>
#include <vector>

#ifdef TROCAR_GDCM
#include <sstream>

#include <gdcmImageChangeTransferSyntax.h>
#include <gdcmImageReader.h>
#include <gdcmImageWriter.h>
#endif

namespace trocar::volumes {

struct PackedDicom {
  std::string syntax, bytes;
};

/// In all lossless syntaxes that GDCM writes.
inline std::vector<PackedDicom> packed_dicom([[maybe_unused]] const std::string& plain) {
  std::vector<PackedDicom> out;
#ifdef TROCAR_GDCM
  for (const auto syntax :
       {gdcm::TransferSyntax::JPEGLosslessProcess14_1, gdcm::TransferSyntax::JPEGLSLossless,
        gdcm::TransferSyntax::JPEG2000Lossless, gdcm::TransferSyntax::RLELossless,
        gdcm::TransferSyntax::ImplicitVRLittleEndian, gdcm::TransferSyntax::DeflatedExplicitVRLittleEndian}) {
    std::istringstream in(plain);
    gdcm::ImageReader reader;
    reader.SetStream(in);
    if (!reader.Read()) continue;
    gdcm::ImageChangeTransferSyntax change;
    change.SetTransferSyntax(syntax);
    change.SetInput(reader.GetImage());
    if (!change.Change()) continue;
    std::ostringstream text;
    gdcm::ImageWriter writer;
    writer.SetStream(text);
    writer.SetFile(reader.GetFile());
    writer.SetImage(change.GetOutput());
    if (writer.Write()) out.push_back({gdcm::TransferSyntax::GetTSString(syntax), text.str()});
  }
#endif
  return out;
}

}  // namespace trocar::volumes
