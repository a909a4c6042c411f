#include <cattaneo/contact/assemble.hpp>
#include <cattaneo/contact/vibrating_body.hpp>
#include <cattaneo/elastic/mass.hpp>

namespace cattaneo
{

VibratingBody vibrating_body(const ElasticBody &body, const std::vector<double> &density)
{
   SharedMatrix M = mass_matrix(body, density); // refuses several ranks
   return {assembled(body), std::move(M)};
}

} // namespace cattaneo
