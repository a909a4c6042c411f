#include <Eigen/LU>
#include <algorithm>
#include <cattaneo/algebra/products.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/relative_displacement.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>

namespace cattaneo
{

using Eigen::Index;

namespace
{

using Sum = std::map<int, double>; ///< coefficients of {u; y}

void add(Sum &sum, const Sum &other, double times)
{
   for (const auto &[column, value] : other) { sum[column] += times * value; }
}

RelativeDisplacement::Matrix matrix(Index rows, const std::vector<Sum> &sums)
{
   std::vector<Eigen::Triplet<double>> entries;
   for (std::size_t row = 0; row < sums.size(); ++row)
   {
      for (const auto &[column, value] : sums[row])
      {
         entries.emplace_back(static_cast<int>(row), column, value);
      }
   }
   RelativeDisplacement::Matrix made(rows, rows);
   made.setFromTriplets(entries.begin(), entries.end());
   return made;
}

/// {v; w} of a contact node by those of a body's node: rows and columns tangential, normal.
SmallMatrix turned(const ContactRow &row, const TraceShare &share, const CondensedBody &body)
{
   const SmallMatrix directions = body.directions(share.of.second);
   const Index d = directions.rows();
   const SmallMatrix weighted =
      Eigen::Vector3d(share.x, share.y, share.z).head(d).asDiagonal() * directions;
   return row.frame(d) * weighted;
}

/// Rows in groups, each after those that it depends on. Rows of one group depend
/// on each other. `on`: the rows that each one depends on.
std::vector<std::vector<int>> groups_in_order(const std::vector<std::vector<int>> &on)
{
   const auto n = static_cast<int>(on.size());
   std::vector<std::vector<int>> groups;
   std::vector<int> number(n, -1), lowest(n, -1), open;
   std::vector<bool> is_open(n, false);
   int next = 0;
   const std::function<void(int)> visit = [&](int i)
   {
      number[i] = lowest[i] = next++;
      open.push_back(i);
      is_open[i] = true;
      for (int j : on[i])
      {
         if (number[j] < 0) { visit(j); }
         if (is_open[j]) { lowest[i] = std::min(lowest[i], lowest[j]); }
      }
      if (lowest[i] < number[i]) { return; }
      groups.emplace_back();
      for (int j = -1; j != i;)
      {
         j = open.back();
         open.pop_back();
         is_open[j] = false;
         groups.back().push_back(j);
      }
   };
   for (int i = 0; i < n; ++i)
   {
      if (number[i] < 0) { visit(i); }
   }
   return groups;
}

/// The components of a node, in its own frame, that lie along the axes of a row. In space the
/// tangents of the frame may be in the other order.
std::array<int, 3> along_axes(const ContactRow &row, const CondensedBody &body, int node)
{
   if (body.line.formulation != Formulation::space) { return {0, 1, 2}; }
   const Eigen::Matrix3d parts = (row.axes * body.directions(node)).cwiseAbs();
   const bool other_order = parts(0, 1) + parts(1, 0) > parts(0, 0) + parts(1, 1) + 1e-9;
   return other_order ? std::array<int, 3>{1, 0, 2} : std::array<int, 3>{0, 1, 2};
}

} // namespace

bool holds(const CondensedBody &body, int node, int component)
{
   const auto row = static_cast<int>(node + component * body.nodes());
   return std::binary_search(body.held.begin(), body.held.end(), row);
}

SmallMatrix ContactRow::frame(Index components) const
{
   if (components == 3) { return axes; }
   SmallMatrix made(2, 2);
   made << tangent[0], tangent[1], -tangent[1], tangent[0];
   return made;
}

const NodeOfBody *ContactRow::partner() const
{
   if (shares.size() != 2) { return nullptr; }
   const int other = shares[0].of == slave ? 1 : 0;
   const double same = 1e-12; // more than the round-off of dual functions
   for (int k : {0, 1})
   {
      const double whole = k == other ? -1 : 1;
      const TraceShare &share = shares[k];
      // Lines have no z.
      const bool has_z = share.z != 0;
      if (std::abs(share.x - whole) > same || std::abs(share.y - whole) > same ||
          (has_z && std::abs(share.z - whole) > same))
      {
         return nullptr;
      }
   }
   return &shares[other].of;
}

void choose_dependents(const std::vector<CondensedBody> &bodies, std::vector<ContactRow> &rows)
{
   const int components = cattaneo::components(bodies.front().line.formulation);
   const double infinite = std::numeric_limits<double>::infinity();
   std::set<NodeOfBody> slaves, taken;
   for (const ContactRow &row : rows) { slaves.insert(row.slave); }
   // A partner with a row of its own is determined by that row, so this row has no choice.
   const auto has_choice = [&](const ContactRow &row)
   { return row.partner() && slaves.count(*row.partner()) == 0; };
   for (ContactRow &row : rows)
   {
      row.dependent = {row.slave, row.slave, row.slave};
      row.component = along_axes(row, bodies[row.slave.first], row.slave.second);
      if (!has_choice(row)) { taken.insert(row.slave); }
   }
   for (ContactRow &row : rows)
   {
      if (!has_choice(row) || taken.count(*row.partner())) { continue; }
      const NodeOfBody partner = *row.partner();
      const std::array<int, 3> its = along_axes(row, bodies[partner.first], partner.second);
      const auto held = [&](const NodeOfBody &at, int c)
      { return holds(bodies[at.first], at.second, c); };
      const auto stiffness = [&](const NodeOfBody &at, int c)
      {
         const CondensedBody &body = bodies[at.first];
         return body.S.diagonal()[at.second + c * body.nodes()];
      };
      double own = 0, other = 0;
      bool any_held = false;
      for (int c = 0; c < components; ++c)
      {
         any_held = any_held || held(row.slave, c) || held(partner, c);
         own += stiffness(row.slave, c);
         other += stiffness(partner, c);
      }
      const double much = 1.01; // more than round-off of equal bodies
      const bool taken_already = taken.count(row.slave) > 0;
      for (int c = 0; c < components; ++c)
      {
         if (any_held)
         {
            const int one = row.component[c];
            own = held(row.slave, one) ? infinite : stiffness(row.slave, one);
            other = held(partner, its[c]) ? infinite : stiffness(partner, its[c]);
         }
         if (taken_already || own > much * other)
         {
            row.dependent[c] = partner;
            row.component[c] = its[c];
         }
      }
      taken.insert(row.dependent.begin(), row.dependent.begin() + components);
   }
}

RelativeDisplacement::RelativeDisplacement(const std::vector<CondensedBody> &bodies,
                                           const std::vector<ContactRow> &rows)
{
   components = cattaneo::components(bodies.front().line.formulation);
   // Numbers of a node's components in U, -1: held or none.
   std::vector<std::vector<int>> number;
   int size = 0;
   for (const CondensedBody &body : bodies)
   {
      offsets.push_back(size);
      number.emplace_back(body.S.rows(), -1);
      free.emplace_back();
      for (int row = 0; row < body.S.rows(); ++row)
      {
         if (std::binary_search(body.held.begin(), body.held.end(), row)) { continue; }
         number.back()[row] = size++;
         free.back().push_back(row);
      }
   }
   const auto dof = [&](const NodeOfBody &at, int component)
   {
      return component < components
                ? number[at.first][at.second + component * bodies[at.first].nodes()]
                : -1;
   };
   // Numbers in u, -1: does not slide.
   const auto n = static_cast<int>(rows.size());
   place.assign(components * n, -1);
   for (int row = 0; row < components * n; ++row)
   {
      if (row < tangents() * n && !rows[row % n].slides[row / n]) { continue; }
      place[row] = static_cast<int>(sliding.size());
      sliding.push_back(row);
   }
   const auto relative = [&](int i, int component)
   { return component < components ? place[i + component * n] : -1; };
   const auto m = static_cast<int>(sliding.size());
   std::vector<int> row_of(size, -1); // the contact node that determines a component of U
   for (int i = 0; i < n; ++i)
   {
      for (int component = 0; component < components; ++component)
      {
         const int own = dof(rows[i].dependent[component], rows[i].component[component]);
         if (own >= 0) { row_of[own] = i; }
      }
   }
   std::vector<Sum> displacement(size), seen(m);
   int y = m;
   for (int k = 0; k < size; ++k)
   {
      if (row_of[k] < 0) { displacement[k][y++] = 1; }
   }
   // The rows that determine what each row depends on.
   std::vector<std::vector<int>> on(n);
   for (int i = 0; i < n; ++i)
   {
      for (const TraceShare &share : rows[i].shares)
      {
         for (int b = 0; b < components; ++b)
         {
            const int column = dof(share.of, b);
            const bool by_row = column >= 0 && row_of[column] >= 0 && row_of[column] != i &&
                                rows[i].axis_of(share.of, b, components) < 0;
            if (by_row && !std::count(on[i].begin(), on[i].end(), row_of[column]))
            {
               on[i].push_back(row_of[column]);
            }
         }
      }
   }
   // Rows that depend on each other are few, those of faces that two interfaces share.
   for (const std::vector<int> &group : groups_in_order(on))
   {
      const auto count = static_cast<int>(components * group.size());
      std::map<int, int> place_in_group; // of dependent components
      for (int k = 0; k < count; ++k)
      {
         const ContactRow &row = rows[group[k / components]];
         const int column = dof(row.dependent[k % components], row.component[k % components]);
         if (column >= 0) { place_in_group[column] = k; }
      }
      // Columns are those of the dependent components.
      Eigen::MatrixXd own = Eigen::MatrixXd::Zero(count, count);
      std::vector<Sum> rest(count);
      for (int first = 0; first < count; first += components)
      {
         const int i = group[first / components];
         const ContactRow &row = rows[i];
         for (const TraceShare &share : row.shares)
         {
            SmallMatrix block = SmallMatrix::Constant(1, 1, share.x);
            if (components > 1) { block = turned(row, share, bodies[share.of.first]); }
            for (int b = 0; b < components; ++b)
            {
               const int axis = row.axis_of(share.of, b, components), column = dof(share.of, b);
               const auto found = place_in_group.find(column);
               const int its = axis >= 0                       ? first + axis
                               : found == place_in_group.end() ? -1
                                                               : found->second;
               if (its >= 0) { own.col(its).segment(first, components) += block.col(b); }
               if (column < 0) { continue; }
               for (int a = 0; a < components; ++a)
               {
                  if (relative(i, a) < 0 || block(a, b) == 0) { continue; }
                  seen[relative(i, a)][column] += block(a, b);
                  if (its < 0) { add(rest[first + a], displacement[column], -block(a, b)); }
               }
            }
         }
         for (int a = 0; a < components; ++a)
         {
            if (relative(i, a) >= 0) { rest[first + a][relative(i, a)] = 1; }
         }
      }
      for (int k = 0; k < count; ++k)
      {
         const int a = k % components;
         if (a == tangents() || rows[group[k / components]].slides[a]) { continue; }
         // It moves perpendicular to the single held direction.
         own.row(k).setZero();
         own.col(k).setZero();
         own(k, k) = 1;
      }
      const Eigen::PartialPivLU<Eigen::MatrixXd> lu(own);
      require(group.size() == 1 || lu.rcond() > 1e-10,
              "reduce: several interfaces meet within faces of a slave, and their rows cannot "
              "be told apart there: make the other side of one of them the slave, or mesh the "
              "sides so that interfaces end where faces end");
      const Eigen::MatrixXd inverse = lu.inverse();
      const double small = group.size() == 1 ? 0 : 1e-15 * inverse.cwiseAbs().maxCoeff();
      for (const auto &[column, k] : place_in_group)
      {
         for (int a = 0; a < count; ++a)
         {
            if (std::abs(inverse(k, a)) > small || group.size() == 1)
            {
               add(displacement[column], rest[a], inverse(k, a));
            }
         }
      }
   }
   E = matrix(size, displacement);
   seen.resize(size);
   G = matrix(size, seen).topRows(m);
}

Eigen::MatrixXd
RelativeDisplacement::stacked(const std::vector<Eigen::MatrixXd> &of_bodies) const
{
   Eigen::MatrixXd all(size(), of_bodies.front().cols());
   for (std::size_t b = 0; b < of_bodies.size(); ++b)
   {
      all.middleRows(offsets[b], static_cast<Index>(free[b].size())) =
         rows_of(of_bodies[b], free[b]);
   }
   return all;
}

Eigen::VectorXd RelativeDisplacement::of_body(int body, const Eigen::VectorXd &U,
                                              Index rows) const
{
   Eigen::VectorXd all = Eigen::VectorXd::Zero(rows);
   for (std::size_t k = 0; k < free[body].size(); ++k)
   {
      all[free[body][k]] = U[offsets[body] + static_cast<Index>(k)];
   }
   return all;
}

} // namespace cattaneo
