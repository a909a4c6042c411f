#include <algorithm>
#include <cattaneo/condense/assembled_body.hpp>
#include <cattaneo/condense/row_links.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <set>
#include <sstream>

namespace cattaneo
{

std::vector<int> AssembledBody::eliminated() const
{
   const SparseView stiffness = K.view();
   const double most = largest_beside_diagonal(stiffness);
   const Eigen::VectorXd diagonals = diagonal_of(stiffness);
   std::vector<bool> connected(components(places.formulation), false); // any row of a component
   std::vector<int> alone;
   for (int dof = 0; dof < K.size(); ++dof)
   {
      if (is_linked(stiffness, places, dof, most, diagonals))
      {
         connected[places.component[dof]] = true;
      }
      else if (!std::binary_search(fixed.begin(), fixed.end(), dof)) { alone.push_back(dof); }
   }
   alone.erase(std::remove_if(alone.begin(), alone.end(),
                              [&](int dof) { return !connected[places.component[dof]]; }),
               alone.end());
   return alone;
}

std::string AssembledBody::eliminated_warning() const
{
   const std::vector<int> rows = eliminated();
   if (rows.empty()) { return ""; }
   return eliminated_rows(rows.size(), places.formulation, places.component[rows[0]],
                          places.called(rows[0])) +
          ": these rows are taken for eliminated supports, and are fixed";
}

std::string eliminated_rows(std::size_t count, Formulation formulation, int component,
                            const std::string &place)
{
   std::ostringstream text;
   text << count << " rows of the stiffness hold nothing but their diagonal, the first is "
        << component_name(formulation, component) << " of the node at " << place;
   return text.str();
}

void AssembledBody::validate() const
{
   const int size = K.size(), components = cattaneo::components(places.formulation);
   const SparseView stiffness = K.view();
   require(size > 0, "assembled body: the stiffness has no rows, must have one at least");
   double largest = 0;
   std::vector<int> last_row(size, -1); // that had an entry in the column
   for (int row = 0; row < size; ++row)
   {
      const int begin = stiffness.outerIndexPtr()[row],
                end = stiffness.outerIndexPtr()[row + 1];
      require(begin <= end, "assembled body: row ", row, " of the stiffness begins at entry ",
              begin, " and ends at ", end, ", must end behind where it begins");
      for (SparseView::InnerIterator entry(stiffness, row); entry; ++entry)
      {
         require(entry.col() >= 0 && entry.col() < size, "assembled body: row ", row,
                 " of the stiffness has an entry in column ", entry.col(),
                 ", must be from 0 to ", size - 1);
         require(last_row[entry.col()] != row, "assembled body: row ", row,
                 " of the stiffness has column ", entry.col(),
                 " twice, must have it once: add the entries up");
         last_row[entry.col()] = row;
         require(std::isfinite(entry.value()), "assembled body: entry (", row, ", ",
                 entry.col(), ") of the stiffness is ", entry.value(), ", must be finite");
         largest = std::max(largest, std::abs(entry.value()));
      }
   }
   // An ElasticBody requires the same of a user's operator. By columns the entries are sorted.
   const Eigen::SparseMatrix<double> by_columns = stiffness,
                                     transposed = by_columns.transpose(),
                                     difference = by_columns - transposed;
   for (int column = 0; column < size; ++column)
   {
      for (Eigen::SparseMatrix<double>::InnerIterator e(difference, column); e; ++e)
      {
         if (std::abs(e.value()) <= 1e-10 * largest) { continue; }
         require(false, "assembled body: the stiffness is not symmetric: entry (", e.row(),
                 ", ", column, ") is ", by_columns.coeff(e.row(), column),
                 " and its mirror image ", by_columns.coeff(column, e.row()),
                 ", they must agree within ", 1e-10 * largest,
                 " (does the matrix have both triangles?)");
      }
      const double diagonal = by_columns.coeff(column, column);
      require(diagonal >= 0, "assembled body: entry (", column, ", ", column,
              ") of the stiffness is ", diagonal, ", its diagonal must not be negative");
   }
   require(places.x.size() == size && places.y.size() == size &&
              static_cast<int>(places.component.size()) == size,
           "assembled body: x, y and component are given for ", places.x.size(), ", ",
           places.y.size(), " and ", places.component.size(), " dofs, must be given for all ",
           size, " of the stiffness");
   const Eigen::Index heights = places.formulation == Formulation::space ? size : 0;
   require(places.z.size() == heights, "assembled body: z is given for ", places.z.size(),
           " dofs, must be given for ", heights, " (all dofs in space, else none)");
   std::vector<bool> held(size, false);
   for (int dof = 0; dof < size; ++dof)
   {
      require(places.component[dof] >= 0 && places.component[dof] < components,
              "assembled body: dof ", dof, " has component ", places.component[dof],
              ", must be from 0 to ", components - 1);
      require(places.place(dof).allFinite(), "assembled body: dof ", dof,
              " has a coordinate that is not finite");
   }
   for (std::size_t k = 0; k < fixed.size(); ++k)
   {
      require(fixed[k] >= 0 && fixed[k] < size, "assembled body: fixed dof ", fixed[k],
              ", must be from 0 to ", size - 1);
      require(k == 0 || fixed[k - 1] < fixed[k], "assembled body: fixed dof ", fixed[k],
              " follows ", fixed[k - 1], ", they must be sorted and each there once");
      held[fixed[k]] = true;
   }
   for (const int dof : grounded ? std::vector<int>() : eliminated())
   {
      require(
         K.diagonal(dof) == 0, "assembled body: row ", dof, " of the stiffness, component ",
         component_name(places.formulation, places.component[dof]), " of the node ",
         places.called(dof), ", holds nothing but its diagonal ", K.diagonal(dof),
         ", like the row of an eliminated support: pass the stiffness as assembled and "
         "fix the row, or say that its supports are eliminated already (supports_left_out of "
         "NodalStiffness, or AssembledBody::grounded); such rows are then fixed");
   }
   if (const auto alone = alone_on_a_slope(stiffness, places, fixed))
   {
      require(false, "assembled body: nothing but ", alone->diagonal,
              " on the diagonal holds the node (", places.x[alone->x], ", ", places.y[alone->x],
              ") along (", alone->direction[0], ", ", alone->direction[1],
              "), as where a support on a slope was eliminated: pass the stiffness as "
              "assembled, turned so that the support is along x or y, and fix it there");
   }
   const double most = largest_beside_diagonal(stiffness);
   const Eigen::VectorXd diagonals = diagonal_of(stiffness);
   std::set<std::string> names;
   for (const BodyLoad &load : loads)
   {
      require(!load.name.empty(), "assembled body: load ", names.size(), " of ", loads.size(),
              " has no name, must have one");
      require(names.insert(load.name).second, "assembled body: two loads are named '",
              load.name, "', must have names of their own: add them up if they are one load");
      require(load.values.size() == size && load.values.allFinite(), "assembled body: load '",
              load.name, "' has ", load.values.size(), " values, must be ", size,
              ", all finite");
      bool moves = false, felt = false;
      for (int dof = 0; load.control == Control::displacement && dof < size; ++dof)
      {
         require(held[dof] || load.values[dof] == 0, "assembled body: load '", load.name,
                 "' displaces dof ", dof, ", which must be among the fixed dofs");
         if (load.values[dof] == 0) { continue; }
         moves = true;
         felt = felt || is_linked(stiffness, places, dof, most, diagonals);
      }
      require(!moves || felt, "assembled body: load '", load.name, "' ", feels_nothing);
   }
   for (const BlockMotion &block : blocks)
   {
      require(block.motion.size() == size && block.motion.allFinite() &&
                 !block.motion.isZero(0) && std::isfinite(block.force),
              "assembled body: a block's motion has ", block.motion.size(),
              " values, must have ", size, ", finite and not all zero, and a finite force");
      for (int dof = 0; dof < size; ++dof)
      {
         require(held[dof] || block.motion[dof] == 0,
                 "assembled body: a guided block moves dof ", dof,
                 ", which must be among the fixed dofs");
      }
      const auto same = [&](const BodyLoad &load)
      { return load.name == block.load && load.control == Control::force; };
      require(block.load.empty() || std::any_of(loads.begin(), loads.end(), same),
              "assembled body: a block is moved by the load '", block.load,
              "', must be a load of forces of the body (which may be zero)");
   }
}

} // namespace cattaneo
