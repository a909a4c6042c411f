#pragma once

#include <cattaneo/reduced/interfaces.hpp>
#include <cattaneo/reduced/mortar.hpp>
#include <cattaneo/reduced/union.hpp>

namespace cattaneo
{

/// A side with the nodes of the condensed body that its own are.
struct Side
{
   int body = -1;
   ContactLine line; ///< its frames along what supports hold
   std::vector<int> nodes;
};

/// An interface whose sides have met: where its rows and all that is known of them come from.
struct MetInterface
{
   const Interface *given = nullptr;
   std::string what; ///< begins sentences about it
   Side slave, master;
   bool of_second = false; ///< the slave is Interface::second
   Mortar mortar;
   std::vector<int> without_row; ///< nodes of the slave

   Eigen::Index nodes() const { return static_cast<Eigen::Index>(mortar.nodes.size()); }
};

/// Contact nodes of all interfaces, which become `met`. If the side that should have the nodes
/// of one cannot, and none is named, the other one has them.
std::vector<ContactRow> rows_of(const std::vector<Interface> &interfaces,
                                const std::vector<CondensedBody> &bodies,
                                std::vector<MetInterface> &met);

InterfaceReport report_of(const MetInterface &interface);

/// What the problem knows of the nodes of an interface that is not tied, which begin at
/// `first`: gaps, weights, places, dofs and chains. `matching`: nodes are also the other
/// body's; `all` are all interfaces.
void add_facts(ReducedProblem &problem, Eigen::Index first, bool matching,
               const MetInterface &interface, const std::vector<MetInterface> &all);

} // namespace cattaneo
