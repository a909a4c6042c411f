#pragma once

#include <Eigen/Dense>
#include <cattaneo/condense/assembled_body.hpp>
#include <cattaneo/condense/contact_line.hpp>
#include <vector>

namespace cattaneo_test
{

/** A body that no finite-element program made: bars of a pin-jointed frame between the points
    of a grid, along its lines and across its cells, each a little stiffer than the one before.
    Its contact is the lowest row of points if the body lies above, else the highest; the other
    one may be held. */
struct Frame
{
   int columns, rows;
   bool above;
   Eigen::MatrixXd K;
   Eigen::VectorXd x, y;

   Frame(int across, int up, bool lies_above, double stiffness = 1);
   int points() const { return columns * rows; }
   int point_of_contact(int i) const // the body on the left
   {
      return above ? i : points() - 1 - i;
   }
   std::vector<int> contact() const;
   cattaneo::ContactLine line() const;
   cattaneo::AssembledBody body(bool held) const;
};

} // namespace cattaneo_test
