// A build without pugixml.
#include "formats/vtk/vtk_dataset.hpp"

namespace meniscus::formats {

VtkDataset read_xml_vtk(const std::string& name, std::string_view bytes, const ReadLimits& /*limits*/, VtkUse /*use*/) {
    ByteCursor(name, bytes).fail("this build reads no XML of VTK: build it where libpugixml-dev is installed");
}

}  // namespace meniscus::formats
