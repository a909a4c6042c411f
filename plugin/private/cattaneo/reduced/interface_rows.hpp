#pragma once

#include <cattaneo/reduced/bodies_union.hpp>
#include <cattaneo/reduced/interfaces.hpp>
#include <cattaneo/reduced/mortar.hpp>
#include <map>

namespace cattaneo
{

/// A node of a body's trace, over all bodies.
using NodeOfBody = std::pair<int, int>;
/// Those that are slaves, with the nodes that they depend on.
using Slaves = std::map<NodeOfBody, std::vector<NodeOfBody>>;

/// A side with the nodes of the condensed body that its own are.
struct Side
{
   int body = -1;
   ContactLine line; ///< its frames along what supports hold
   std::vector<int> nodes;
};

/// Ends of a side that supports hold in both components: nodes that move nowhere carry no row.
/// `nodes`: those of the body that the line's are.
std::vector<int> clamped_ends(const CondensedBody &body, const ContactLine &line,
                              const std::vector<int> &nodes);

/// One interface as it is worked on.
class InterfaceRows
{
public:
   InterfaceRows(const Interface &given, const std::vector<CondensedBody> &bodies);

   /// Adds its rows. If the side that should have the nodes cannot, and none is named, the
   /// other one has them.
   void add_rows(std::vector<ContactRow> &rows, Slaves &taken);
   InterfaceReport report() const;
   /// Of an interface that is not tied, whose nodes begin at `first`.
   /// `all` are all interfaces.
   void add_facts(ReducedProblem &problem, Eigen::Index first, bool matching,
                  const std::vector<InterfaceRows> &all) const;
   /// Is the node of a body on one of its sides?
   bool has(const NodeOfBody &node) const;
   bool tied() const { return given_.tied; }
   Eigen::Index nodes() const { return static_cast<Eigen::Index>(mortar_.nodes.size()); }
   const Side &slave() const { return slave_; }
   const Side &master() const { return master_; }

private:
   Side side(const InterfaceSide &given) const;
   void face_all(const std::vector<int> &without);
   void pair_nodes(const std::vector<int> &without);
   void meet(const std::vector<int> &without);
   /// Nothing if it throws.
   void add_slave(std::vector<ContactRow> &rows, Slaves &taken, bool in_rings);
   ContactRow row(Eigen::Index i) const;
   void check_row(const ContactRow &row, Eigen::Index i) const;
   const int *faced(Eigen::Index i, const Eigen::Vector2d &tangent) const;
   /// Is a node of the slave paired with one that no support holds?
   bool partner_is_free(int node) const;
   LineEnd other_end(Eigen::Index i, bool last) const;

   const Interface &given_;
   const std::vector<CondensedBody> &bodies_;
   std::string what_;
   Side slave_, master_;
   bool of_second_ = false;
   Mortar mortar_;
   std::vector<bool> slides_;
   std::vector<int> without_row_; ///< nodes of the slave
};

/// Contact nodes of all interfaces, which `facings` becomes.
std::vector<ContactRow> rows_of(const std::vector<Interface> &interfaces,
                                const std::vector<CondensedBody> &bodies,
                                std::vector<InterfaceRows> &facings);

} // namespace cattaneo
