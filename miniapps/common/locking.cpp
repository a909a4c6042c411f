#include "common/locking.hpp"

#include "common/miniapp.hpp"

#include <iostream>

namespace miniapp
{

using namespace cattaneo;

bool locks(int order, const Material &material)
{
   return order == 1 && material.poisson >= 0.49 && material.state == PlaneState::strain;
}

void warn_of_locking(int order, const Material &material)
{
   if (!locks(order, material) || !writes()) { return; }
   std::cerr << "warning: linear elements lock at Poisson's ratio " << material.poisson
             << ": the body is too stiff; use option -order 2\n";
}

} // namespace miniapp
