#include "frontalis/model/skin_film.hpp"

#include <cmath>

namespace frontalis
{

double film_wavelength(const FilmLaw& film)
{
  return 6.283185307179586 * film.thickness * std::cbrt(film.modulus / (3 * film.base_modulus));
}

double film_critical_strain(const FilmLaw& film)
{
  return 0.25 * std::pow(3 * film.base_modulus / film.modulus, 2.0 / 3);
}

}  // namespace frontalis
