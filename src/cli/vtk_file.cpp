#include "cli/vtk_file.hpp"

#include <fmt/core.h>

#include <utility>

namespace frontalis
{

VtkFile::VtkFile(std::string type, std::string sizes) : type_(std::move(type)), sizes_(std::move(sizes)) {}

void VtkFile::add_names(const std::string& name, const std::vector<std::string>& names)
{
  names_ +=
      fmt::format("<DataArray type=\"String\" Name=\"{}\" NumberOfTuples=\"{}\" format=\"ascii\">", name, names.size());
  for (const std::string& text : names)
  {
    for (const char letter : text)
      names_ += fmt::format("{} ", static_cast<unsigned char>(letter));
    names_ += "0 ";  // the end of a string
  }
  names_ += "</DataArray>\n";
}

void VtkFile::begin(const std::string& element, const std::string& attributes)
{
  if (!element_.empty())
    xml_ += "</" + element_ + ">\n";
  element_ = element;
  xml_ += attributes.empty() ? "<" + element + ">\n" : "<" + element + " " + attributes + ">\n";
}

void VtkFile::declare(const std::string& name, const char* type, std::size_t components)
{
  xml_ +=
      fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{}\"/>\n",
                  type, name, components, bytes_.size());
}

std::string VtkFile::text() const
{
  return fmt::format(
             "<?xml version=\"1.0\"?>\n<VTKFile type=\"{0}\" version=\"1.0\" byte_order=\"LittleEndian\" "
             "header_type=\"UInt64\">\n<{0}>{1}<Piece {2}>\n",
             type_, names_.empty() ? "" : "<FieldData>\n" + names_ + "</FieldData>\n", sizes_) +
         xml_ + "</" + element_ + ">\n</Piece></" + type_ + ">\n<AppendedData encoding=\"raw\">_" + bytes_ +
         "</AppendedData>\n</VTKFile>\n";
}

}  // namespace frontalis
