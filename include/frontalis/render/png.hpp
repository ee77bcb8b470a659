#pragma once

#include <cstdint>
#include <string>

namespace frontalis
{

/// A PNG image of `channels` 1 (grey) or 3 (red, green, blue), 8 or 16 bits, rows from the top without gaps. Throws
/// Error if libpng fails.
std::string png_of(const std::uint8_t* pixels, int width, int height, int channels);
std::string png_of(const std::uint16_t* pixels, int width, int height);

}  // namespace frontalis
