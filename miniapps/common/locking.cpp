#include "common/locking.hpp"

#include "common/miniapp.hpp"

#include <sstream>

namespace miniapp
{

using namespace cattaneo;

bool locks(int order, const Material &material)
{
   return order == 1 && material.poisson >= 0.49 && material.state == PlaneState::strain;
}

void warn_of_locking(int order, const Material &material)
{
   if (!locks(order, material)) { return; }
   std::ostringstream text;
   text << "linear elements lock at Poisson's ratio " << material.poisson
        << ": the body is too stiff; use option -order 2";
   warn(text.str());
}

} // namespace miniapp
