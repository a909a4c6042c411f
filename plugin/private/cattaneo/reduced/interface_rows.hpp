#pragma once

#include <cattaneo/reduced/interfaces.hpp>
#include <cattaneo/reduced/mortar.hpp>
#include <cattaneo/reduced/surface_mortar.hpp>
#include <cattaneo/reduced/union.hpp>

namespace cattaneo
{

/// A side of an interface, and the numbers that its nodes have in the condensed body.
struct Side
{
   int body = -1;
   ContactLine line; ///< its frames turned to the directions that supports hold
   std::vector<int> nodes;
   ContactSurface surface = {}; ///< in space, in place of the line
};

/// An interface after its sides were matched; its rows and all data about them are computed
/// from this.
struct MetInterface
{
   const Interface *given = nullptr;
   std::string what; ///< begins messages about it
   Side slave, master;
   bool of_second = false; ///< the slave is Interface::second
   /// In space only its nodes, gaps and weights are set.
   Mortar mortar;
   std::vector<int> without_row; ///< nodes of the slave
   /// In space, of each contact node: the node of the master. Empty if the nodes do not match.
   std::vector<int> facing = {};
   SurfaceMortar surfaces = {}; ///< in space, of nodes that do not match

   Eigen::Index nodes() const { return static_cast<Eigen::Index>(mortar.nodes.size()); }
};

/// Finds the contact nodes of all interfaces, and fills `met`. If the side that should have the
/// nodes cannot have them, and the user named none, the other side has them.
std::vector<ContactRow> rows_of(const std::vector<Interface> &interfaces,
                                const std::vector<CondensedBody> &bodies,
                                std::vector<MetInterface> &met);

InterfaceReport report_of(const MetInterface &interface);

/// Fills in the gaps, weights, places, dofs and chains of the nodes of an interface that is not
/// tied, which begin at `first`. `matching`: each node is also one of the other body. `all` are
/// all interfaces.
void add_facts(ReducedProblem &problem, Eigen::Index first, bool matching,
               const MetInterface &interface, const std::vector<MetInterface> &all);

} // namespace cattaneo
