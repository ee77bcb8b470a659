#include "frontalis/render/png.hpp"

#include "frontalis/error.hpp"

#include <png.h>

namespace frontalis
{
namespace
{

std::string packed(const void* pixels, int width, int height, std::uint32_t format)
{
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<std::uint32_t>(width);
  image.height = static_cast<std::uint32_t>(height);
  image.format = format;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(&image, bytes.data(), &size, 0, pixels, 0, nullptr) == 0)
    throw Error(std::string("an image cannot be written: ") + image.message);
  bytes.resize(size);
  return bytes;
}

}  // namespace

std::string png_of(const std::uint8_t* pixels, int width, int height, int channels)
{
  return packed(pixels, width, height, channels == 1 ? PNG_FORMAT_GRAY : PNG_FORMAT_RGB);
}

std::string png_of(const std::uint16_t* pixels, int width, int height)
{
  return packed(pixels, width, height, PNG_FORMAT_LINEAR_Y);
}

}  // namespace frontalis
