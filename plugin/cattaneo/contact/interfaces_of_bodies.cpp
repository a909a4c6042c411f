#include <cattaneo/contact/interfaces_of_bodies.hpp>
#include <cattaneo/input_error.hpp>

namespace cattaneo
{

Reduction reduce(const std::vector<NamedBody> &bodies,
                 const std::vector<BoundaryInterface> &interfaces,
                 const CondenseSettings &settings)
{
   const auto count = static_cast<int>(bodies.size());
   std::vector<std::vector<ContactLine>> lines(bodies.size());
   const auto side = [&](const BoundaryInterface &interface, const BoundarySide &of)
   {
      if (of.body == -1) { return InterfaceSide(); }
      require(of.body >= 0 && of.body < count, "interface '", interface.name,
              "': a side names body ", of.body, ", must be from 0 to ", count - 1,
              ", or -1 for a rigid obstacle as the second side");
      lines[of.body].push_back(contact_line(*bodies[of.body].body, of.part));
      lines[of.body].back().as_meshed = interface.as_meshed;
      return InterfaceSide{of.body, lines[of.body].back()};
   };
   std::vector<Interface> all;
   for (const BoundaryInterface &each : interfaces)
   {
      const InterfaceSide first = side(each, each.first), second = side(each, each.second);
      all.push_back(
         {each.name, first, second, each.slave, each.gap, each.most_overlap, each.tied});
   }
   std::vector<CondensedBody> condensed;
   for (int b = 0; b < count; ++b)
   {
      require(!lines[b].empty(), "reduce: body '", bodies[b].name,
              "' is in no interface, so nothing touches it: name an interface for it, or leave "
              "the body out");
      const ContactLine line = joined(lines[b]);
      // The last body whose factor this one may share.
      const CondensedBody *alike = nullptr;
      for (const CondensedBody &before : condensed)
      {
         if (before.line.size() == line.size()) { alike = &before; }
      }
      condensed.push_back(condense(*bodies[b].body, line, settings, alike));
      condensed.back().name = bodies[b].name;
   }
   return reduce(std::move(condensed), all);
}

} // namespace cattaneo
