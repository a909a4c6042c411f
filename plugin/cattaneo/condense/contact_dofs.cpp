#include <algorithm>
#include <cattaneo/condense/contact_dofs.hpp>
#include <cattaneo/input_error.hpp>

namespace cattaneo
{

std::vector<int> contact_dofs(const ElasticBody &body, const ContactLine &line)
{
   const auto n = line.size();
   require(n > 0 && line.true_dofs.size() == static_cast<std::size_t>(n),
           "unsupported body: the contact line has ", n, " nodes and ", line.true_dofs.size(),
           " pairs of dofs, must have as many and at least one");
   const Ranks &ranks = body.ranks();
   const mfem::Array<int> essential_dofs = body.essential_dofs();
   const std::vector<int> essential(essential_dofs.begin(), essential_dofs.end());
   const int components = body.components(), first = body.first_global_dof();
   const int dofs = body.dofs();
   std::vector<int> contact(components * n);
   for (Eigen::Index i = 0; i < n; ++i)
   {
      for (int c = 0; c < components; ++c)
      {
         const int dof = line.true_dofs[i][c];
         require(dof >= 0 && dof < dofs, "condense: contact dof ", dof, " of node ", i,
                 " of the line, must be from 0 to ", dofs - 1, " (is it a line of this body?)");
         contact[c * n + i] = dof;
      }
   }
   // On all ranks alike, the owner of a dof knows.
   std::vector<double> fixed;
   for (std::size_t a = 0; a < contact.size(); ++a)
   {
      if (std::binary_search(essential.begin(), essential.end(), contact[a] - first))
      {
         fixed.push_back(static_cast<double>(a));
      }
   }
   fixed = ranks.gather(fixed);
   if (!fixed.empty())
   {
      const auto a = static_cast<Eigen::Index>(*std::min_element(fixed.begin(), fixed.end()));
      require(false, "condense: component ", component_name(body.geometry(), a / n),
              " of the contact node at (", line.position(a % n, 0), ", ",
              line.position(a % n, 1), ") is fixed or prescribed, contact nodes must be free");
   }
   return contact;
}

} // namespace cattaneo
