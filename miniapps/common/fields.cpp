#include "common/fields.hpp"

#include "common/miniapp.hpp"

#include <cattaneo/output/paraview.hpp>

namespace miniapp
{

using namespace cattaneo;

void write_paraview(const std::string &folder, Reduction &reduction,
                    const std::vector<const ElasticBody *> &bodies,
                    const std::vector<ContactState> &states)
{
   ContactLineFields contact(reduction.problem, folder, "contact");
   for (const ContactState &state : states)
   {
      if (writes()) { contact.write(state); }
   }
   for (std::size_t k = 0; k < bodies.size(); ++k)
   {
      // A body that every rank has for itself is written by one.
      if (!writes() && !bodies[k]->ranks().several()) { continue; }
      BodyFields fields(*bodies[k], folder, "body" + std::to_string(k + 1));
      for (const ContactState &state : states)
      {
         fields.write(
            reduction.displacement(static_cast<int>(k), state.v, state.w, state.multipliers),
            state.time);
      }
   }
}

} // namespace miniapp
