#include <algorithm>
#include <cattaneo/reduced/relative_displacement.hpp>
#include <map>

namespace cattaneo
{

using Eigen::Index;
using Eigen::Matrix2d;

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
Matrix2d turned(const ContactRow &row, const TraceShare &share, const Matrix2d &directions)
{
   const Eigen::Vector2d &t = row.tangent, n(-t[1], t[0]), weight(share.x, share.y),
                         v = weight.cwiseProduct(directions.col(0)),
                         w = weight.cwiseProduct(directions.col(1));
   Matrix2d block;
   block << t.dot(v), t.dot(w), n.dot(v), n.dot(w);
   return block;
}

} // namespace

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
   const auto dof = [&](int body, int node, int component)
   {
      return component < components ? number[body][node + component * bodies[body].line.size()]
                                    : -1;
   };
   // Numbers in u, -1: does not slide.
   const auto n = static_cast<int>(rows.size());
   std::vector<std::array<int, 2>> relative(rows.size(), {-1, -1});
   for (int component = 0; component < components; ++component)
   {
      for (int i = 0; i < n; ++i)
      {
         if (component == 0 && !rows[i].slides) { continue; }
         relative[i][component] = static_cast<int>(sliding.size());
         sliding.push_back(i + component * n);
      }
   }
   const auto m = static_cast<int>(sliding.size());
   std::vector<int> slave_of(size, -1); // the contact node whose slave a component of U is
   for (int i = 0; i < n; ++i)
   {
      for (int component : {0, 1})
      {
         const int own = dof(rows[i].body, rows[i].node, component);
         if (own >= 0) { slave_of[own] = i; }
      }
   }
   std::vector<Sum> displacement(size), seen(m);
   int y = m;
   for (int k = 0; k < size; ++k)
   {
      if (slave_of[k] < 0) { displacement[k][y++] = 1; }
   }
   std::vector<bool> made(rows.size(), false);
   // Of the nodes that a slave depends on first. Slaves that are masters as well are few, and
   // no deeper than there are interfaces.
   const std::function<void(int)> make = [&](int i)
   {
      if (made[i]) { return; }
      made[i] = true;
      const ContactRow &row = rows[i];
      Matrix2d own = Matrix2d::Zero();
      std::array<Sum, 2> rest;
      for (const TraceShare &share : row.shares)
      {
         Matrix2d block = share.x * Matrix2d::Identity();
         if (components == 2)
         {
            block = turned(row, share, bodies[share.body].directions(share.node));
         }
         const bool is_own = share.body == row.body && share.node == row.node;
         if (is_own) { own += block; }
         for (int b : {0, 1})
         {
            const int column = dof(share.body, share.node, b);
            if (column < 0) { continue; }
            if (!is_own && slave_of[column] >= 0) { make(slave_of[column]); }
            for (int a : {0, 1})
            {
               if (relative[i][a] < 0 || block(a, b) == 0) { continue; }
               seen[relative[i][a]][column] += block(a, b);
               if (!is_own) { add(rest[a], displacement[column], -block(a, b)); }
            }
         }
      }
      for (int a : {0, 1})
      {
         if (relative[i][a] >= 0) { rest[a][relative[i][a]] = 1; }
      }
      if (!row.slides) // it moves across what is held alone
      {
         own(0, 0) = 1;
         own(0, 1) = own(1, 0) = 0;
      }
      const Matrix2d inverse = own.inverse();
      for (int b : {0, 1})
      {
         const int column = dof(row.body, row.node, b);
         if (column < 0) { continue; }
         for (int a : {0, 1}) { add(displacement[column], rest[a], inverse(b, a)); }
      }
   };
   for (int i = 0; i < n; ++i) { make(i); }
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
         of_bodies[b](free[b], Eigen::all);
   }
   return all;
}

} // namespace cattaneo
