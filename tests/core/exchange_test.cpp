// Stiffnesses of other programs. Files and expectations are those of data/exchange/make.py and
// of a real CalculiX 2.20, which wrote the .sti.

#include "comparison.hpp"
#include "expect_input_error.hpp"

#include <cattaneo/condense/condense.hpp>
#include <cattaneo/exchange/nodal_statements.hpp>
#include <cattaneo/exchange/outer_edges.hpp>
#include <cattaneo/exchange/read_stiffness.hpp>
#include <cattaneo/exchange/write_stiffness.hpp>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/reduced/interfaces.hpp>
#include <cattaneo/whole_file.hpp>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <random>

namespace
{

using namespace cattaneo;
using Eigen::MatrixXd;
using Eigen::VectorXd;

const std::string folder = std::string(CATTANEO_SOURCE_DIR) + "/tests/data/exchange/";

/// In global components, {x; y} of the contact nodes.
MatrixXd expected(const std::string &name)
{
   std::ifstream in(folder + "expected.json");
   const auto rows = nlohmann::json::parse(in).at(name).get<std::vector<std::vector<double>>>();
   MatrixXd S(rows.size(), rows.size());
   for (std::size_t i = 0; i < rows.size(); ++i)
   {
      for (std::size_t j = 0; j < rows.size(); ++j) { S(i, j) = rows[i][j]; }
   }
   return S;
}

VectorXd vector(std::initializer_list<double> values)
{
   return Eigen::Map<const VectorXd>(values.begin(), static_cast<Eigen::Index>(values.size()));
}

/// Files are written where the test program has its own.
class Exchange : public testing::Test
{
protected:
   Exchange() : before_(std::filesystem::current_path())
   {
      std::filesystem::current_path(testing::TempDir());
   }
   ~Exchange() override { std::filesystem::current_path(before_); }

private:
   std::filesystem::path before_;
};

NodalStiffness lower_lap()
{
   NodalStiffness lower = read_stiffness(folder + "rows.mtx");
   lower.name = "lower";
   return lower;
}

TEST_F(Exchange, CalculixLapsAreFoundAndNamed)
{
   const NodalStiffness laps = read_stiffness(folder + "laps.sti");
   const std::vector<NodalStiffness> parts = laps.parts();
   ASSERT_EQ(parts.size(), 2);
   // By the lowest number of their nodes, called by their element sets.
   EXPECT_EQ(parts[0].name, "LOWER");
   EXPECT_EQ(parts[1].name, "UPPER");
   EXPECT_EQ(parts[0].dofs.size(), 20); // its floor was taken out
   EXPECT_EQ(parts[1].dofs.size(), 30);
   EXPECT_TRUE(parts[0].loads.empty());
   ASSERT_EQ(parts[1].loads.size(), 2);
   EXPECT_EQ(parts[1].loads[0].name, "CLOAD1");
   EXPECT_EQ(parts[1].loads[0].values.sum(), -1.5 * 5);
   EXPECT_EQ(parts[1].loads[1].values.sum(), 3);
   EXPECT_EQ(parts[1].sets.count("FLOOR"), 0);
   EXPECT_EQ(parts[0].nodes_of("floor").size(), 5);

   const ContactLine below = parts[0].contact_line(parts[0].nodes_of("LOWER_FACE")),
                     above = parts[1].contact_line(parts[1].nodes_of("upper_face"));
   // Along the boundary with the body on the left, by the elements.
   EXPECT_EQ(above.nodes.front().position, Eigen::Vector2d(0.5, 0));
   EXPECT_EQ(above.nodes.front().tangent, Eigen::Vector2d(1, 0));
   EXPECT_EQ(below.nodes.front().position, Eigen::Vector2d(2, 0));
   EXPECT_EQ(below.nodes.front().tangent, Eigen::Vector2d(-1, 0));
   EXPECT_LT((above.each(&LineNode::weight) - vector({0.25, 0.5, 0.5, 0.5, 0.25})).norm(),
             1e-15);
   EXPECT_LT((above.each(&LineNode::arc_length) - vector({0, 0.5, 1, 1.5, 2})).norm(), 1e-15);
   EXPECT_EQ(above.chains[0].ends, (std::array<LineEnd, 2>{LineEnd::corner, LineEnd::corner}));

   const CondensedBody lower = condense(parts[0].body(), below),
                       upper = condense(parts[1].body(), above);
   EXPECT_EQ(lower.free_motions.cols(), 0);
   EXPECT_EQ(upper.free_motions.cols(), 3);
   // CalculiX writes 14 digits.
   EXPECT_LT(difference(lower.S, expected("lower")), 1e-12);
   EXPECT_LT(difference(upper.S, expected("upper")), 1e-12);
   EXPECT_LT((upper.S * upper.rigid_motions()).norm(), 1e-13 * upper.S.norm());
}

TEST_F(Exchange, CalculixLapsMarch)
{
   std::vector<NodalStiffness> parts = read_stiffness(folder + "laps.sti").parts();
   std::vector<CondensedBody> bodies;
   std::vector<InterfaceSide> sides;
   for (const char *face : {"LOWER_FACE", "UPPER_FACE"})
   {
      const NodalStiffness &part = parts[bodies.size()];
      sides.push_back(
         {static_cast<int>(bodies.size()), part.contact_line(part.nodes_of(face))});
      bodies.push_back(condense(part.body(), sides.back().line));
   }
   Reduction reduction = reduce(bodies, {{"face", sides[1], sides[0]}});
   ReducedProblem &problem = reduction.problem;
   EXPECT_EQ(problem.nodes(), 4); // the fifth of the upper one hangs over
   set_friction(problem, 0.5);
   ContactState state = ContactState::virgin(problem);
   const MarchReport report = march(
      problem,
      LoadHistory::through(problem, {{}, {{"CLOAD1", 1}}, {{"CLOAD1", 1}, {"CLOAD2", 1}}}),
      state);
   EXPECT_EQ(report.status, FrictionStatus::converged);
   EXPECT_NEAR(state.p.sum(), 7.5, 1e-12);
   EXPECT_NEAR(std::abs(state.q.sum()), 3, 1e-12);
}

TEST_F(Exchange, CalculixQuadraticElements)
{
   const NodalStiffness block = read_stiffness(folder + "quadratic.sti");
   const ContactLine line = block.contact_line(block.nodes_of("BOTTOM"));
   EXPECT_EQ(line.chains[0].elements.size(), 4);
   EXPECT_EQ(line.chains[0].elements[0].order(), 2);
   // Simpson's weights of elements of length 1/2.
   EXPECT_LT((line.each(&LineNode::weight) * 12 - vector({1, 4, 2, 4, 2, 4, 2, 4, 1})).norm(),
             1e-14);
   EXPECT_LT(difference(condense(block.body(), line).S, expected("quadratic")), 1e-12);
}

TEST_F(Exchange, CalculixRingIsAFlatWedge)
{
   const NodalStiffness ring = read_stiffness(folder + "ring.sti");
   EXPECT_EQ(ring.formulation, Formulation::axisymmetric);
   EXPECT_EQ(ring.loads[0].values.sum(), -3); // of the whole circumference
   const ContactLine line = ring.contact_line(ring.nodes_of("BOTTOM"));
   ASSERT_EQ(line.size(), 4); // the node on the axis is none
   EXPECT_EQ(line.chains[0].ends[0], LineEnd::symmetry);
   EXPECT_NEAR(line.each(&LineNode::weight).sum(), M_PI * 4, 1e-12);
   const CondensedBody body = condense(ring.body(), line);
   EXPECT_EQ(body.free_motions.cols(), 1);
   const double flat = difference(body.S, expected("ring"));
   EXPECT_LT(flat, 5e-4);
   EXPECT_GT(flat, 1e-5);
}

TEST_F(Exchange, AbaqusSparseWithSupports)
{
   const NodalStiffness lower = read_stiffness(folder + "abaqus.mtx");
   EXPECT_EQ(lower.dofs.size(), 30);
   EXPECT_EQ(lower.fixed.size(), 10); // 1e36 on the diagonal
   const ContactLine line = lower.contact_line(lower.nodes_of("face"));
   EXPECT_LT(difference(condense(lower.body(), line).S, expected("lower")), 1e-13);
}

/// A support on a contact node's x, as ABAQUS writes it, and fixed here.
TEST_F(Exchange, AbaqusSupportsOnContactNodesAreHeldThere)
{
   std::string lines = read_whole(folder + "abaqus.mtx");
   const std::string diagonal = "\n11,1,11,1,";
   const std::size_t value = lines.find(diagonal) + diagonal.size();
   ASSERT_GE(value, diagonal.size());
   lines.replace(value, lines.find('\n', value) - value, "1e36");
   write_whole("supported.mtx", lines);
   write_whole("supported.inp", read_whole(folder + "abaqus.inp"));
   const NodalStiffness supported = read_stiffness("supported.mtx");
   NodalStiffness held = read_stiffness(folder + "abaqus.mtx");
   held.fix({11}, 1);
   EXPECT_EQ(supported.parts().size(), 1);
   const auto condensed = [](const NodalStiffness &stiffness)
   { return condense(stiffness.body(), stiffness.contact_line(stiffness.nodes_of("FACE"))); };
   const CondensedBody expected = condensed(held), found = condensed(supported);
   EXPECT_EQ(found.held, expected.held);
   EXPECT_EQ(found.held.size(), 1);
   EXPECT_LT(difference(found.S, expected.S), 1e-13);
   // It cannot be moved: its forces are lost.
   write_whole("supported.inp",
               read_whole(folder + "abaqus.inp") + "*STEP\n*BOUNDARY\n11, 1, 1, 0.1\n");
   expect_input_error([] { read_stiffness("supported.mtx"); },
                      "must be without support in the step");
}

/// FORMAT=COORDINATE: row, column and value, rows by the numbers of nodes.
TEST_F(Exchange, AbaqusRowsThatAreNumbered)
{
   const NodalStiffness named = read_stiffness(folder + "abaqus.mtx");
   const auto write = [&](const auto &number)
   {
      std::ostringstream lines;
      lines.precision(17);
      for (int row = 0; row < named.K.rows(); ++row)
      {
         for (NodalStiffness::Matrix::InnerIterator k(named.K, row); k; ++k)
         {
            const bool supported =
               std::binary_search(named.fixed.begin(), named.fixed.end(), row);
            lines << number(named.dofs[row]) << ' ' << number(named.dofs[k.col()]) << ' '
                  << (supported ? 1e36 : k.value()) << '\n';
         }
      }
      write_whole("coordinate_STIF1.mtx", lines.str());
      write_whole("coordinate.inp", read_whole(folder + "abaqus.inp"));
      return read_stiffness("coordinate_STIF1.mtx");
   };
   // Nodes are 1 to 15.
   const NodalStiffness numbered =
      write([](const NodeDof &dof) { return 2 * dof.node - 2 + dof.direction; });
   ASSERT_EQ(numbered.dofs.size(), named.dofs.size());
   const std::map<NodeDof, int> rows = named.rows();
   for (std::size_t i = 0; i < named.dofs.size(); ++i)
   {
      for (std::size_t j = 0; j < named.dofs.size(); ++j)
      {
         EXPECT_EQ(numbered.K.coeff(i, j),
                   named.K.coeff(rows.at(numbered.dofs[i]), rows.at(numbered.dofs[j])));
      }
   }
   const ContactLine line = numbered.contact_line(numbered.nodes_of("FACE"));
   EXPECT_LT(difference(condense(numbered.body(), line).S, expected("lower")), 1e-13);
   // x of all nodes, then y of all.
   expect_input_error(
      [&] { write([](const NodeDof &dof) { return dof.node + 15 * (dof.direction - 1); }); },
      "rows are numbered in another way");
}

/// K of one spring of `k` between internal node -1 and node 1, another to node 2, and 5 across.
TEST_F(Exchange, AbaqusInternalNodesAreEliminated)
{
   write_whole("internal.mtx", "1,1,1,1,2.\n1,2,1,2,5.\n2,1,2,1,3.\n2,2,1,2,-5.\n2,2,2,2,5.\n"
                               "-1,1,1,1,-2.\n-1,1,2,1,-3.\n-1,1,-1,1,5.\n");
   write_whole("internal.inp", "*NODE\n1, 0., 0.\n2, 1., 0.\n");
   const NodalStiffness springs = read_stiffness("internal.mtx");
   ASSERT_EQ(springs.dofs.size(), 4);
   const double series = 1 / (1 / 2.0 + 1 / 3.0);
   for (int a = 0; a < 4; ++a)
   {
      for (int b = 0; b < 4; ++b)
      {
         const NodeDof &i = springs.dofs[a], &j = springs.dofs[b];
         const double k = i.direction != j.direction ? 0 : i.direction == 1 ? series : 5;
         EXPECT_NEAR(springs.K.coeff(a, b), i.node == j.node ? k : -k, 1e-15);
      }
   }
}

TEST_F(Exchange, ASuperelementIsTakenAsItIs)
{
   const NodalStiffness dense = read_stiffness(folder + "superelement.mtx");
   EXPECT_THROW(dense.contact_line(dense.nodes_of("FACE")), InputError); // no elements
   const ContactLine line = dense.contact_line({15, 14, 13, 12, 11}, 1);
   const CondensedBody body = condense(dense.body(), line);
   EXPECT_LT(difference(body.S, expected("lower")), 1e-14);
   EXPECT_EQ(body.free_motions.cols(), 0);
}

TEST_F(Exchange, RowsOfAnyProgram)
{
   const NodalStiffness market = lower_lap();
   const ContactLine line = market.contact_line(market.nodes_of("FACE"), 1);
   EXPECT_LT(difference(condense(market.body(), line).S, expected("lower")), 1e-13);
   for (const char *file : {"rows.npy", "rows_csr.npz", "rows_dense.npz"})
   {
      const NodalStiffness other = read_stiffness(folder + file, folder + "rows.dofs");
      EXPECT_EQ(MatrixXd(other.K), MatrixXd(market.K)) << file;
      EXPECT_EQ(other.fixed, market.fixed);
   }
   expect_input_error([]
                      { read_stiffness(folder + "rows_compressed.npz", folder + "rows.dofs"); },
                      "is compressed, must not be");
   // Places that are no integers are neither cut to integers nor gone to.
   expect_input_error([]
                      { read_stiffness(folder + "damaged_index.npz", folder + "rows.dofs"); },
                      "row 2 has index 0.5, must be an integer from 0 to 1");
   expect_input_error([]
                      { read_stiffness(folder + "damaged_start.npz", folder + "rows.dofs"); },
                      "indptr and shape are no square matrix");
}

/// Zeros between bodies connect nothing: dense forms have them, sparse ones may.
TEST_F(Exchange, BodiesOfADenseMatrixAreFound)
{
   NodalStiffness laps = read_stiffness(folder + "laps.sti");
   const std::vector<NodalStiffness> sparse = laps.parts();
   NodalStiffness stored = laps; // every zero of it
   const auto size = static_cast<int>(laps.dofs.size());
   std::vector<Eigen::Triplet<double>> all;
   for (int i = 0; i < size; ++i)
   {
      for (int j = 0; j < size; ++j) { all.emplace_back(i, j, laps.K.coeff(i, j)); }
   }
   stored.K.setFromTriplets(all.begin(), all.end());
   std::ostringstream text;
   text.precision(17);
   text << "%%MatrixMarket matrix array real general\n" << size << " " << size << "\n";
   for (const Eigen::Triplet<double> &entry : all) { text << entry.value() << "\n"; }
   laps.loads.clear(); // or it cannot be written
   write_matrix_market("dense.mtx", laps);
   write_whole("dense.mtx", text.str());
   write_abaqus("element.mtx", laps);
   for (const NodalStiffness &dense :
        {stored, read_stiffness("dense.mtx"), read_stiffness("element.mtx")})
   {
      const std::vector<NodalStiffness> parts = dense.parts();
      ASSERT_EQ(parts.size(), 2) << dense.name;
      EXPECT_EQ(parts[1].K.nonZeros(), sparse[1].K.nonZeros());
      NodalStiffness upper = parts[1];
      upper.edges = sparse[1].edges;
      const ContactLine line = upper.contact_line(upper.nodes_of("UPPER_FACE"));
      const CondensedBody body = condense(upper.body(), line);
      EXPECT_EQ(body.free_motions.cols(), 3);
      EXPECT_LT(difference(body.S, expected("upper")), 1e-12);
   }
   // Of both at once, one of them free, what the other one is does not matter.
   const CondensedBody both =
      condense(stored.body(), stored.contact_line(stored.nodes_of("UPPER_FACE")));
   EXPECT_EQ(both.free_motions.cols(), 3);
   EXPECT_LT(difference(both.S, expected("upper")), 1e-12);
}

/// A program may number its rows as it likes: of each two entries one is there.
TEST_F(Exchange, EntriesOfEitherTriangle)
{
   std::ifstream in(folder + "abaqus.mtx");
   std::string text;
   int count = 0;
   for (std::string line; std::getline(in, line);)
   {
      const std::size_t middle = line.find(',', line.find(',') + 1), end = line.rfind(',');
      text += ++count % 2 == 0 ? line
                               : line.substr(middle + 1, end - middle - 1) + "," +
                                    line.substr(0, middle) + line.substr(end);
      text += "\n";
   }
   write_whole("turned.mtx", text);
   const NodalStiffness turned = read_stiffness("turned.mtx", folder + "abaqus.inp"),
                        known = read_stiffness(folder + "abaqus.mtx");
   std::vector<int> order;
   for (const NodeDof &dof : known.dofs) { order.push_back(turned.rows().at(dof)); }
   const MatrixXd K = turned.K;
   EXPECT_EQ(MatrixXd(K(order, order)), MatrixXd(known.K));
}

/// A spring along x from a corner of a block to the ground: in the deck as CalculiX and ABAQUS
/// have it, and in K.
TEST_F(Exchange, SpringsToTheGroundHold)
{
   const NodalStiffness block = read_stiffness(folder + "quadratic.sti");
   const int node = block.nodes_of("BOTTOM").front(), row = block.rows().at({node, 1});
   std::ostringstream sti;
   sti.precision(17);
   for (int i = 0; i < block.K.rows(); ++i)
   {
      for (NodalStiffness::Matrix::InnerIterator entry(block.K, i); entry; ++entry)
      {
         if (entry.col() < i) { continue; }
         const double spring = i == row && entry.col() == row ? 500 : 0;
         sti << i + 1 << " " << entry.col() + 1 << " " << entry.value() + spring << "\n";
      }
   }
   write_whole("springs.sti", sti.str());
   write_whole("springs.dof", read_whole(folder + "quadratic.dof"));
   const std::string deck = read_whole(folder + "quadratic.inp");
   write_whole("springs.inp", deck);
   const auto condensed = [&]
   {
      const NodalStiffness held = read_stiffness("springs.sti");
      return condense(held.body(), held.contact_line(held.nodes_of("BOTTOM")));
   };
   expect_input_error([&] { condensed(); }, "it resists a translation along x");
   write_whole("springs.inp", deck + "*ELEMENT, TYPE=SPRING1, ELSET=GROUND\n9001, " +
                                 std::to_string(node) + "\n*SPRING, ELSET=GROUND\n1\n500.\n");
   const CondensedBody held = condensed();
   EXPECT_EQ(held.free_motions.cols(), 2); // along y, and about that corner
   const ContactLine line = block.contact_line(block.nodes_of("BOTTOM"));
   const CondensedBody free = condense(block.body(), line);
   EXPECT_EQ(free.free_motions.cols(), 3);
   MatrixXd springs = held.S - free.S;
   EXPECT_NEAR(springs.cwiseAbs().maxCoeff(), 500, 1e-6);
   EXPECT_NEAR(springs.cwiseAbs().sum(), 500, 1e-6);
}

/// Sentences and names are UTF-8, whatever the alphabet of a file.
TEST_F(Exchange, OlderAlphabets)
{
   write_whole("m.sti", "1 1 1.\n2 2 1.\n");
   write_whole("m.dof", "1.1\n1.2\n");
   const std::string nodes = "** Gr\xF6\xDF"
                             "e in mm\n*NODE, NSET=FL\xC4"
                             "CHE\n1, 0., 0.\n";
   write_whole("m.inp", nodes);
   EXPECT_EQ(read_stiffness("m.sti").nodes_of("FL\u00C4"
                                              "CHE"),
             NodalStiffness::Nodes{1});
   write_whole("m.inp", nodes + "2, \xE9, 0.\n");
   expect_input_error([&] { read_stiffness("m.sti"); }, "line 4: x of a node is '\u00E9'");
   write_whole("m.inp", nodes + "2, \u00E9, 0.\n");
   expect_input_error([&] { read_stiffness("m.sti"); }, "line 4: x of a node is '\u00E9'");
   write_whole("m.sti", "\xEF\xBB\xBF"
                        "1 1 1.\r\n2 2 1.\r\n");
   write_whole("m.inp", "\xEF\xBB\xBF*NODE\r\n1, 0., 0.\r\n");
   EXPECT_EQ(read_stiffness("m.sti").places.size(), 1);
}

TEST_F(Exchange, LinesByOrderAreThoseByElements)
{
   for (const char *file : {"laps.sti", "quadratic.sti"})
   {
      NodalStiffness part = read_stiffness(folder + file).parts().back();
      const bool quadratic = part.name == "BLOCK";
      NodalStiffness::Nodes nodes = part.nodes_of(quadratic ? "BOTTOM" : "UPPER_FACE");
      const int order = quadratic ? 2 : 1;
      const ContactLine by_elements = part.contact_line({nodes.rbegin(), nodes.rend()}),
                        by_order = part.contact_line(nodes, order);
      ASSERT_EQ(by_order.size(), by_elements.size());
      for (Eigen::Index i = 0; i < by_order.size(); ++i)
      {
         EXPECT_EQ(by_order.nodes[i].dofs, by_elements.nodes[i].dofs);
         EXPECT_EQ(by_order.nodes[i].weight, by_elements.nodes[i].weight);
         EXPECT_EQ(by_order.nodes[i].tangent, by_elements.nodes[i].tangent);
      }
      std::reverse(nodes.begin(), nodes.end());
      expect_input_error([&] { part.contact_line(nodes, order); }, "body is on the right");
      nodes.pop_back();
      if (quadratic)
      {
         expect_input_error([&] { part.contact_line(nodes, 2); },
                            "8 nodes in elements of order 2");
      }
   }
}

TEST_F(Exchange, TractionsAreConsistent)
{
   NodalStiffness block = read_stiffness(folder + "quadratic.sti");
   block.add_traction("T", block.nodes_of("BOTTOM"), {2, -3});
   const VectorXd &values = block.loads.back().values;
   const VectorXd simpson = vector({1, 4, 2, 4, 2, 4, 2, 4, 1}) / 12;
   for (int i = 0; i < 9; ++i)
   {
      EXPECT_NEAR(values[2 * i], 2 * simpson[i], 1e-15);
      EXPECT_NEAR(values[2 * i + 1], -3 * simpson[i], 1e-15);
   }
   // About an axis, hat functions on r: 2π ∫φ r dr, the node on the axis too.
   NodalStiffness ring = read_stiffness(folder + "ring.sti");
   ring.add_traction("T", ring.nodes_of("BOTTOM"), {0, 1});
   const double h = 0.5;
   for (std::size_t row = 0; row < ring.dofs.size(); ++row)
   {
      const NodeDof &dof = ring.dofs[row];
      if (dof.direction != 2 || dof.node > 5) { continue; }
      const double r = h * (dof.node - 1), end = dof.node == 5 ? r * h / 2 - h * h / 6 : r * h;
      EXPECT_NEAR(ring.loads.back().values[row], 2 * M_PI * (dof.node == 1 ? h * h / 6 : end),
                  1e-13);
   }
}

TEST_F(Exchange, SupportsAndLoadsByName)
{
   NodalStiffness block = read_stiffness(folder + "quadratic.sti");
   block.sets["TOP"] = {37, 38, 39, 40, 41, 42, 43, 44, 45};
   block.add_displacement("press", block.nodes_of("top"), 2, -0.1);
   block.fix(block.nodes_of("TOP"), 1);
   block.add_forces("pull", {20}, 1, 3.0);
   const AssembledBody body = block.body();
   EXPECT_EQ(body.fixed.size(), 18);
   const Eigen::VectorXd &pressing = body.loads[0].values;
   EXPECT_EQ((pressing.array() == -0.1).count(), 9);
   EXPECT_EQ((pressing.array() == 0).count(), pressing.size() - 9);
   EXPECT_EQ(body.loads[1].values.sum(), 3);
   const CondensedBody pressed = condense(body, block.contact_line(block.nodes_of("BOTTOM")));
   // Forces of the clamped bottom and of the pull are in balance with the held top.
   EXPECT_EQ(pressed.rigid_modes, 0);
   EXPECT_GT(pressed.patterns[0].p.minCoeff(), 0);
   expect_input_error([&] { block.add_forces("press", {20}, 1, 1); },
                      "forces and displacements");
   expect_input_error([&] { block.fix({99}, 1); }, "there is no node 99");
   expect_input_error([&] { block.fix({1}, 3); }, "direction 3, must be 1 or 2");
   expect_input_error([&] { block.nodes_of("side"); }, "must be one of: BLOCK, BOTTOM, TOP");
   const NodalStiffness lower = read_stiffness(folder + "abaqus.mtx");
   NodalStiffness moved = lower;
   moved.fix(lower.nodes_of("FLOOR"), 1); // held already
   EXPECT_EQ(moved.fixed, lower.fixed);
   expect_input_error([&] { moved.add_displacement("up", lower.nodes_of("FLOOR"), 2, 1); },
                      "moves node 1 in direction 2, whose row holds nothing but its diagonal");
}

TEST_F(Exchange, SupportsAndLoadsAsStatements)
{
   NodalStiffness block = read_stiffness(folder + "quadratic.sti");
   block.sets["TOP"] = {37, 38, 39, 40, 41, 42, 43, 44, 45};
   block.sets["END"] = {9, 18};
   add_supports(block, "support1", "end:x TOP:xy");
   EXPECT_EQ(block.fixed.size(), 20);
   add_loads(block, "load1",
             "P traction BOTTOM 0 2; P force end 0.5 0\n D displacement-y TOP -3");
   ASSERT_EQ(block.loads.size(), 2);
   EXPECT_NEAR(block.loads[0].values.sum(), 2 * 2 + 2 * 0.5, 1e-14);
   EXPECT_EQ(block.loads[1].values.sum(), -27);
   EXPECT_EQ(block.loads[1].control, Control::displacement);
   for (const char *wrong : {"TOP", "TOP:", "TOP:z", "TOP:xyz", ":x", "SIDE:x"})
   {
      EXPECT_THROW(add_supports(block, "support1", wrong), InputError) << wrong;
   }
   for (const char *wrong : {"P", "P force TOP", "P force TOP 1", "P force SIDE 1 1",
                             "P pressure TOP 1", "P traction TOP 1 x", "P displacement-z TOP 1",
                             "P=1 force TOP 1 1", "D force TOP 1 1", "P traction END 1 1 1"})
   {
      EXPECT_THROW(add_loads(block, "load1", wrong), InputError) << wrong;
   }
   expect_input_error([&] { add_loads(block, "load1", "P traction TOP"); },
                      "load1 'P traction TOP': must be PATTERN force SET fx fy");
   expect_input_error([&] { add_supports(block, "support1", "TOP:z"); },
                      "support1 'TOP:z': must be SET:x, SET:y or SET:xy");
}

TEST_F(Exchange, DigitsThatAreMissingAreSaid)
{
   NodalStiffness block = read_stiffness(folder + "quadratic.sti");
   for (int row = 0; row < block.K.rows(); ++row) { block.K.coeffRef(row, row) *= 1 + 1e-7; }
   expect_input_error([&] { block.body(); }, "it resists a translation along x by");
   block.supports_left_out = true; // a foundation
   EXPECT_NO_THROW(block.body());
}

TEST_F(Exchange, WhatIsWrittenComesBack)
{
   NodalStiffness lower = lower_lap();
   lower.add_forces("P", {13, 14}, 2, -1.0 / 3);
   write_matrix_market("back.mtx", lower);
   const NodalStiffness market = read_stiffness("back.mtx");
   EXPECT_EQ(MatrixXd(market.K), MatrixXd(lower.K));
   EXPECT_EQ(market.sets, lower.sets);
   EXPECT_EQ(market.places, lower.places);
   EXPECT_EQ(market.fixed, lower.fixed);
   ASSERT_EQ(market.loads.size(), 1);
   EXPECT_EQ(market.loads[0].name, "P");
   EXPECT_EQ(market.loads[0].values, lower.loads[0].values);

   write_abaqus("element.mtx", lower);
   const NodalStiffness element = read_stiffness("element.mtx");
   EXPECT_EQ(MatrixXd(element.K), MatrixXd(lower.K));
   EXPECT_EQ(element.nodes_of("FACE"), lower.nodes_of("FACE"));
   EXPECT_EQ(element.fixed, lower.fixed);
   EXPECT_EQ(element.loads[0].values, lower.loads[0].values);

   write_npz("arrays.npz", lower);
   write_matrix_market("arrays.mtx", lower); // for its .dofs
   EXPECT_EQ(MatrixXd(read_stiffness("arrays.npz").K), MatrixXd(lower.K));

   // Or without them, by what it has itself.
   write_npz("whole.npz", lower);
   const NodalStiffness whole = read_stiffness("whole.npz");
   EXPECT_EQ(MatrixXd(whole.K), MatrixXd(lower.K));
   ASSERT_EQ(whole.dofs.size(), lower.dofs.size());
   for (std::size_t row = 0; row < lower.dofs.size(); ++row)
   {
      EXPECT_EQ(whole.dofs[row].node, lower.dofs[row].node);
      EXPECT_EQ(whole.dofs[row].direction, lower.dofs[row].direction);
   }
   EXPECT_EQ(whole.fixed, lower.fixed);
   EXPECT_EQ(whole.supports_left_out, lower.supports_left_out);
   EXPECT_EQ(whole.formulation, lower.formulation);
   EXPECT_EQ(whole.nodes_of("FACE"), lower.nodes_of("FACE"));
   for (const NodeDof &dof : lower.dofs)
   {
      EXPECT_EQ(whole.places.at(dof.node), lower.places.at(dof.node));
   }
   ASSERT_EQ(whole.loads.size(), lower.loads.size());
   EXPECT_EQ(whole.loads[0].name, lower.loads[0].name);
   EXPECT_EQ(whole.loads[0].values, lower.loads[0].values);

   lower.add_displacement("U", {1}, 1, 1);
   for (auto write : {+[](const NodalStiffness &of) { write_abaqus("element.mtx", of); },
                      +[](const NodalStiffness &of) { write_npz("arrays.npz", of); }})
   {
      expect_input_error([&] { write(lower); }, "load 'U' prescribes displacements");
   }
   lower.loads[0].name = "P and Q";
   expect_input_error([&] { write_matrix_market("back.mtx", lower); },
                      "'P and Q', must be one word");
   expect_input_error([&] { write_matrix_market("back.txt", lower); }, "must end with .mtx");
   expect_input_error([&] { write_npz("arrays.npz", lower_lap(), MatrixXd::Identity(3, 3)); },
                      "mass matrix: it is 3×3, must be 30×30");
}

/// What the program held has no rows, and is in no set of what is written.
TEST_F(Exchange, SetsOfHeldNodesAreWrittenWithoutThem)
{
   NodalStiffness lower = read_stiffness(folder + "laps.sti").parts()[0];
   EXPECT_EQ(lower.nodes_of("FLOOR").size(), 5);
   NodalStiffness::Nodes free = lower.nodes_of("LOWER");
   for (int node : lower.nodes_of("FLOOR"))
   {
      free.erase(std::remove(free.begin(), free.end(), node), free.end());
   }
   EXPECT_EQ(free.size(), 10);
   write_matrix_market("held.mtx", lower);
   write_abaqus("held_element.mtx", lower);
   for (const char *file : {"held.mtx", "held_element.mtx"})
   {
      const NodalStiffness back = read_stiffness(file);
      EXPECT_EQ(back.K.toDense(), lower.K.toDense());
      EXPECT_FALSE(back.has_set("FLOOR"));
      EXPECT_EQ(back.nodes_of("LOWER"), free);
      EXPECT_TRUE(back.supports_left_out);
   }
}

/// A body of revolution stays one: its contact forces are of the whole circumference.
TEST_F(Exchange, AnAxisymmetricSuperelementComesBack)
{
   const NodalStiffness ring = read_stiffness(folder + "ring.sti");
   const ContactLine line = ring.contact_line(ring.nodes_of("BOTTOM"));
   const NodalStiffness element = nodal_stiffness(condense(ring.body(), line));
   write_abaqus("ring_element.mtx", element);
   const NodalStiffness back = read_stiffness("ring_element.mtx");
   EXPECT_EQ(back.formulation, Formulation::axisymmetric);
   NodalStiffness::Nodes nodes = back.nodes_of("CONTACT");
   const ContactLine again = back.contact_line(nodes, 1);
   // One element less, whose other node is on the axis and has no row.
   EXPECT_NEAR(again.each(&LineNode::weight).sum(), M_PI * (4 - 0.25), 1e-12);
}

TEST_F(Exchange, ACondensedBodyIsASuperelement)
{
   NodalStiffness lower = lower_lap();
   lower.add_forces("P", {8}, 2, -1.0);
   const CondensedBody body =
      condense(lower.body(), lower.contact_line(lower.nodes_of("FACE"), 1));
   write_abaqus("condensed.mtx", nodal_stiffness(body));
   const NodalStiffness back = read_stiffness("condensed.mtx");
   const CondensedBody again =
      condense(back.body(), back.contact_line(back.nodes_of("CONTACT"), 1));
   EXPECT_LT(difference(again.S, body.S), 1e-14);
   EXPECT_LT((again.patterns[0].p - body.patterns[0].p).norm(), 1e-14);
   EXPECT_LT((again.patterns[0].q - body.patterns[0].q).norm(), 1e-14);
}

/// By hand, by the columns of Nastran's wide fields.
TEST_F(Exchange, NastranTakesAMatrixAsDmig)
{
   NodalStiffness bar;
   bar.K.resize(2, 2);
   bar.K.insert(0, 0) = 3;
   bar.K.insert(0, 1) = bar.K.insert(1, 0) = -1.23456789012345;
   bar.K.insert(1, 1) = 2e-101;
   bar.dofs = {{7, 1}, {12, 2}};
   bar.places = {{7, {0.25, -1}}, {12, {1.0 / 3, 0}}, {40, {9, 9}}};
   bar.fixed = {1};
   bar.supports_left_out = true;
   bar.loads = {{"P", Control::force, VectorXd::Unit(2, 1) * -2.5}};
   write_nastran("bar.bdf", bar);
   EXPECT_EQ(read_whole("bar.bdf"),
             "$ stiffness of a body\n"
             "GRID*                  7               02.5000000000E-01-1.000000000E+00\n"
             "*       0.0000000000E+00\n"
             "GRID*                 12               03.3333333333E-010.0000000000E+00\n"
             "*       0.0000000000E+00\n"
             "DMIG    KAAX           0       6       2       0\n"
             "DMIG*   KAAX                           7               1\n"
             "*                      7               13.0000000000D+00\n"
             "*                     12               2-1.234567890D+00\n"
             "DMIG*   KAAX                          12               2\n"
             "*                     12               22.000000000D-101\n"
             "SPC1*                  1               2              12\n"
             "*\n"
             "$ load 1: P\n"
             "FORCE*                 1              12               0-2.500000000E+00\n"
             "*       0.0000000000E+001.0000000000E+000.0000000000E+00\n");
   bar.dofs[0].node = 0; // counted from 0: 0 and 12 are 1 and 13 there, 40 has no row
   bar.places[0] = bar.places[7];
   write_nastran("bar.bdf", bar);
   const std::string shifted = read_whole("bar.bdf");
   EXPECT_NE(shifted.find("*                     13               2-1.234567890D+00"),
             std::string::npos);
   EXPECT_NE(shifted.find("FORCE*                 1              13"), std::string::npos);
   bar.add_displacement("U", {0}, 1, 1);
   expect_input_error([&] { write_nastran("bar.bdf", bar); }, "prescribes displacements");
}

/// For joint dynamics. Bodies that are held in series: K⁻¹ = L S⁻¹ Lᵀ of the united problem.
TEST_F(Exchange, SeparateBodiesAndTheirRelativeDisplacements)
{
   std::vector<NodalStiffness> parts = read_stiffness(folder + "laps.sti").parts();
   for (int direction : {1, 2}) { parts[1].fix(parts[1].nodes_of("TOP"), direction); }
   parts[1].loads.clear();
   parts[1].add_forces("P", {108}, 2, -3);
   const ContactLine below = parts[0].contact_line(parts[0].nodes_of("LOWER_FACE")),
                     above = parts[1].contact_line(parts[1].nodes_of("UPPER_FACE"));
   const std::vector<CondensedBody> bodies = {condense(parts[0].body(), below),
                                              condense(parts[1].body(), above)};
   const std::vector<Interface> faces = {{"face", {1, above}, {0, below}}};
   const ReducedProblem problem = reduce(bodies, faces).problem;
   const SeparateBodies apart = separate(bodies, faces);
   ASSERT_EQ(apart.K.rows(), 20);
   ASSERT_EQ(apart.L.rows(), 8);
   EXPECT_EQ(apart.patterns[0].name, "P");
   const MatrixXd flexible = apart.K.inverse() * apart.L.transpose();
   const MatrixXd series = (apart.L * flexible).inverse();
   EXPECT_LT(difference(series, problem.K), 1e-12);
   // Clamped: U = K⁻¹(Lᵀ f - f_1) with L U = 0.
   const VectorXd clamped = series * flexible.transpose() * apart.loads.col(0);
   EXPECT_LT((clamped.head(4) - problem.patterns[0].q).norm(), 1e-12);
   EXPECT_LT((clamped.tail(4) - problem.patterns[0].p).norm(), 1e-12);
}

TEST_F(Exchange, NumpyReadsWhatIsWritten)
{
   NodalStiffness lower = lower_lap();
   lower.add_forces("P", {13}, 2, -2.5);
   const CondensedBody body =
      condense(lower.body(), lower.contact_line(lower.nodes_of("FACE"), 1));
   write_npz("body.npz", nodal_stiffness(body), MatrixXd::Identity(10, 10));
   ReducedProblem problem = reduce(body).problem;
   problem.patterns.push_back(
      {"two", Control::force, VectorXd::LinSpaced(5, 1, 5), VectorXd::LinSpaced(5, 6, 10)});
   problem.H = MatrixXd::Zero(2, 2);
   write_npz("problem.npz", problem);
   write_npz("lower.npz", lower);
   write_whole(
      "read.py",
      "import sys\n"
      "try:\n   import numpy\nexcept ImportError:\n   sys.exit(77)\n"
      "b = numpy.load('body.npz'); p = numpy.load('problem.npz')\n"
      "held = numpy.load('lower.npz'); rows = held['dofs'][held['fixed'].astype(int).ravel()]\n"
      "assert sorted(map(tuple, rows)) == [(n, c) for n in range(1, 6) for c in (1, 2)], rows\n"
      "assert {'K', 'M', 'dofs', 'fixed', 'loads', 'places', 'load P', 'set CONTACT'} <= "
      "set(b), sorted(b)\n"
      "assert b['K'].shape == (10, 10) and (b['M'] == numpy.eye(10)).all()\n"
      "assert b['loads'].sum() == -2.5 and b['places'][0, 0] == 2.0\n"
      "assert abs(p['K'] - p['K'].T).max() == 0 and p['gap'].shape == (5, 1)\n"
      "assert p['loads'].shape == (10, 2), p['loads'].shape\n"
      "assert abs(p['loads'][:, 0].sum() + 2.5) < 1e-12, p['loads']\n"
      "assert (p['loads'][:, 1] == numpy.arange(1., 11.)).all(), p['loads']\n"
      "assert abs(p['K'].trace() - b['K'].trace()) < 1e-9\n");
   const int code = std::system("python3 read.py || /usr/bin/python3 read.py");
   if (WEXITSTATUS(code) == 77) { GTEST_SKIP() << "there is no NumPy"; }
   EXPECT_EQ(code, 0);
}

/// A file of a kind with one mistake, and what must be said of it.
struct Mistake
{
   const char *file, *content, *says;
};

TEST_F(Exchange, EntriesOfNumpysMatricesAreCountedByRowsOrByColumns)
{
   for (const bool by_columns : {false, true})
   {
      std::string head =
         "{'descr': '<f8', 'fortran_order': " + std::string(by_columns ? "True" : "False") +
         ", 'shape': (2, 2), }";
      head += std::string(117 - head.size(), ' ') + "\n";
      std::string content =
         std::string("\x93NUMPY\x01\x00", 8) + char(head.size()) + '\0' + head;
      const double values[] = {1, 2, 3, 4};
      content.append(reinterpret_cast<const char *>(values), sizeof values);
      write_whole("m.npy", content);
      write_whole("m.dofs", "1 1 0 0\n1 2 0 0\n");
      expect_input_error([&] { read_stiffness("m.npy"); },
                         by_columns ? "row 1, row 2) is 3 and its mirror image 2"
                                    : "row 1, row 2) is 2 and its mirror image 3");
   }
}

TEST_F(Exchange, WhatAContactLineOfAListNeedsIsNamed)
{
   write_whole("m.mtx",
               "%%MatrixMarket matrix array real general\n3 3\n2\n0\n0\n0\n2\n0\n0\n0\n2\n");
   write_whole("m.dofs", "1 1 0 0\n1 2 0 0\n2 1 1 0\n");
   const NodalStiffness body = read_stiffness("m.mtx");
   EXPECT_FALSE(body.supports_left_out);
   expect_input_error(
      [&] {
         body.contact_line({1, 2});
      },
      "no elements are known, nodes must be given in order");
   expect_input_error(
      [&] {
         body.contact_line({1, 2}, 1);
      },
      "direction 2 of node 2 has no row");
   expect_input_error([&] { body.contact_line({1, 3}, 1); }, "there is no node 3");
   write_whole("m.sti", "1 1 1.\n2 2 1.\n2 3 1.\n");
   write_whole("m.dof", "1.1\n1.2\n");
   write_whole("m.inp", "*NODE\n1, 0., 2.\n");
   expect_input_error([&] { read_stiffness("m.sti"); },
                      "entry (2, 3), must be within 2×2, which 'm.dof' has");
}

TEST_F(Exchange, ADeckMayNameTheThirdCoordinateOrEndItsLinesWithAComma)
{
   write_whole("m.sti", "1 1 1.\n2 2 1.\n3 3 1.\n4 4 1.\n");
   write_whole("m.dof", "1.1\n1.2\n2.1\n2.2\n");
   for (const char *nodes :
        {"*NODE\n1, 0., 2.\n2, 1., 2.\n", "*NODE\n1, 0., 2., 0.\n2, 1., 2.,\n",
         "*NODE\n1, 0., 2., \n2, 1., 2., 0\n", "*NODE\n1, 0., 2., , 0.\n2, 1., 2., ,\n"})
   {
      write_whole("m.inp", nodes);
      EXPECT_EQ(read_stiffness("m.sti").places.at(2), Eigen::Vector2d(1, 2)) << nodes;
   }
   // Round-off is no third dimension, and the plane may be anywhere.
   for (const char *nodes : {"*NODE\n1, 0., 2., 1e-17\n2, 1., 2.\n",
                             "*NODE\n1, 0., 2., 12.5\n2, 1., 2., 12.5000000001\n"})
   {
      write_whole("m.inp", nodes);
      EXPECT_EQ(read_stiffness("m.sti").places.at(2), Eigen::Vector2d(1, 2)) << nodes;
   }
   for (const char *nodes :
        {"*NODE\n1, 0., 2., 1.\n2, 1., 2.\n", "*NODE\n1, 0., 2.\n2, 1., 2., 1e-8\n"})
   {
      write_whole("m.inp", nodes);
      expect_input_error([&] { read_stiffness("m.sti"); }, "must be in one plane z = const");
   }
   NodalStiffness twisting = lower_lap();
   twisting.formulation = Formulation::torsion;
   expect_input_error([&] { twisting.validate(); }, "its formulation is torsion");
}

/// What holds one body is no excuse for another one: a free body's damaged matrix is seen.
TEST_F(Exchange, AFreeBodyBesideASupportedOneMustBeFree)
{
   const std::vector<NodalStiffness> laps = read_stiffness(folder + "laps.sti").parts();
   ASSERT_EQ(laps.size(), 2);
   EXPECT_TRUE(laps[0].supports_left_out);
   EXPECT_FALSE(laps[1].supports_left_out);
   EXPECT_EQ(laps[1].body().fixed.size(), 0);
   NodalStiffness damaged = laps[1];
   int column = 0; // of a neighbour of row 0
   for (NodalStiffness::Matrix::InnerIterator e(damaged.K, 0); e; ++e)
   {
      if (e.col() > 0 && std::abs(e.value()) > 1e-2 * damaged.K.coeff(0, 0))
      {
         column = static_cast<int>(e.col());
      }
   }
   ASSERT_GT(column, 0);
   damaged.K.coeffRef(0, column) *= 1 + 1e-6;
   expect_input_error([&] { damaged.body(); }, "the stiffness is not symmetric: entry (");
   damaged.K.coeffRef(column, 0) = damaged.K.coeff(0, column);
   expect_input_error([&] { damaged.body(); }, "it resists a ");
   NodalStiffness free = laps[1];
   free.supports_left_out = false;
   write_npz("whole_laps.npz", free);
   // On springs it may resist, and so may all if supports may be anybody's.
   NodalStiffness both = read_stiffness(folder + "laps.sti");
   both.on_springs = {laps[1].dofs[0].node};
   EXPECT_TRUE(both.parts()[1].supports_left_out);
   both.on_springs.clear();
   both.edges.clear();
   EXPECT_TRUE(both.parts()[1].supports_left_out);
   // Of a matrix with all of its rows no part is without some.
   NodalStiffness whole = read_stiffness("whole_laps.npz");
   for (const NodalStiffness &part : whole.parts()) { EXPECT_FALSE(part.supports_left_out); }
}

/// Of a deck beside a matrix nothing that loads is passed over.
TEST_F(Exchange, LoadsThatARowCannotHaveAreRefused)
{
   write_whole("m.sti", "1 1 1.\n2 2 1.\n");
   write_whole("m.dof", "1.1\n1.2\n");
   for (const char *card : {"DLOAD", "DSLOAD", "Temperature",
                            "Initial Conditions, user, type = stress", "INERTIA RELIEF"})
   {
      write_whole("m.inp", std::string("*NODE\n1, 0., 2.\n*") + card + "\n1, P3, 50.\n");
      expect_input_error([&] { read_stiffness("m.sti"); },
                         "loads elements, which is not supported beside a matrix");
   }
   write_whole("m.inp", "*NODE\n1, 0., 2.\n*INITIAL CONDITIONS, TYPE=TEMPERATURE\n1, 50.\n");
   EXPECT_NO_THROW(read_stiffness("m.sti")); // of which no step makes a strain
   write_whole("m.inp", "*NODE\n1, 0., 2.\n*BOUNDARY\n1, 3\n*CLOAD\n1, 3, 7.\n");
   expect_input_error([&] { read_stiffness("m.sti"); },
                      "'CLOAD1' loads node 1 direction 3, the direction of a force must be 1");
   // A force without a row may be on what the deck holds, nowhere else.
   const std::string two = "*NODE\n1, 0., 2.\n2, 0., 0.\n*BOUNDARY\n2, 2\n*CLOAD\n";
   write_whole("m.inp", two + "2, 2, 7.\n1, 2, 3.\n");
   EXPECT_EQ(read_stiffness("m.sti").loads.at(0).values, Eigen::Vector2d(0, 3));
   for (const char *dof : {"2, 1", "3, 2", "1, 0"})
   {
      write_whole("m.inp", two + dof + ", 7.\n");
      expect_input_error([&] { read_stiffness("m.sti"); }, "'CLOAD1' loads node ");
   }
}

/// Distances of 1/3 have eight digits at 1e7, six at 1e9.
TEST_F(Exchange, PlacesFarFromTheOriginAreRefused)
{
   NodalStiffness lower = read_stiffness(folder + "laps.sti").parts()[0];
   const auto moved = [&](double by)
   {
      NodalStiffness away = lower;
      for (auto &[node, place] : away.places) { place += Eigen::Vector2d(by, -by); }
      return away;
   };
   EXPECT_NO_THROW(moved(1e7).body());
   for (double by : {1e9, -1e9})
   {
      expect_input_error([&] { moved(by).body(); }, "move the origin nearer");
   }
}

TEST_F(Exchange, MistakesAreToldInOneSentence)
{
   const std::string deck = "*NODE\n1, 0., 0.\n2, 1., 0.\n", banner = "%%MatrixMarket matrix ";
   for (const Mistake &m : std::vector<Mistake>{
           {"m.txt", "", "ends with '.txt', must end with .sti, .mtx, .npy or .npz"},
           {"m.mtx", "", "is empty"},
           {"m.mtx", "1,1,1,1,2.\n1,1,1,x,3.\n",
            "line 2: a direction is 'x', must be an integer"},
           {"m.mtx", "1,1,1,1,nan\n", "line 1: an entry is 'nan', must be a finite number"},
           {"m.mtx", "1,1,1,1,1e999\n", "must be a finite number"},
           {"m.mtx", "1,1,1,1\n",
            "line 1: '1,1,1,1', must be node, direction, node, direction and"},
           {"m.mtx", "1,6,1,6,2.\n", "direction 6 of node 1, must be 1 or 2"},
           {"m.mtx",
            "%%MatrixMarket matrix coordinate real general\n2 2 3\n1 1 1.\n2 2 1.\n"
            "1 -2147483648 1.\n",
            "entry (1, -2147483648), must be within 2×2"},
           {"m.mtx", "1,3,1,3,2.\n", "plane strain with E (1 + 2ν)/(1 + ν)²"},
           {"m.mtx", "1,1,1,1,2.\n1,1,1,1,3.\n",
            "entry (node 1 direction 1, node 1 direction 1) is listed twice"},
           {"m.mtx", "1,1,1,1,2.\n2,1,2,1,2.\n2,1,1,1,1.\n1,1,2,1,1.1\n", "must be symmetric"},
           {"m.mtx", "1,1,1,1,2.\n2,1,1,1,1.\n", "node 2 direction 1) is 0, the diagonal"},
           {"m.mtx", "1,1,1,1,-2.\n", "is -2, the diagonal of a stiffness must be positive"},
           {"m.mtx", "7,1,7,1,2.\n", "node 7 has no place"},
           {"m.mtx", "*USER ELEMENT, LINEAR\n", "*USER ELEMENT, must have NODES="},
           {"m.mtx", "*USER ELEMENT, NODES=1, LINEAR\n1, 2\n*MATRIX, TYPE=STIFFNESS\n1.\n",
            "lists 0 of them, must list all"},
           {"m.mtx",
            "*USER ELEMENT, NODES=1\n** ELEMENT NODES\n** 1\n1, 2\n*MATRIX, "
            "TYPE=STIFFNESS\n1.\n",
            "1 entries of a stiffness of 2 rows, its triangle must have 3"},
           {"m.mtx", "*USER ELEMENT, NODES=1\n** ELEMENT NODES\n** 1\n1, 2, 6\n",
            "direction 6 of node 1, must be 1 or 2"},
           {"m.npy", "nonsense", "is no NumPy array"},
           {"m.npz", "nonsense", "is no complete zip archive"},
        })
   {
      write_whole(m.file, m.content);
      write_whole("m.inp", deck);
      expect_input_error([&] { read_stiffness(m.file); }, m.says);
   }
   write_whole("m.dof", "1.1\n1.4\n");
   write_whole("m.sti", "1 1 2.\n2 2 2.\n");
   expect_input_error([] { read_stiffness("m.sti"); },
                      "line 2: direction 4 of node 1, must be 1 or 2");
   for (const Mistake &m : std::vector<Mistake>{
           {"coordinate real symmetric\n", "2 3 2\n", "the matrix is 2×3, must be square"},
           {"coordinate real symmetric\n", "2 2 2\n1 1 1\n", "it has 1 of 2 entries"},
           {"coordinate real symmetric\n", "2 2 2\n1 1 1\n3 1 1\n",
            "entry (3, 1), must be within 2×2"},
           {"coordinate real symmetric\n", "2 2 2\n1 1 1\n2 2 1\n2 1 1\n",
            "there are more entries than the 2 that the file states"},
           {"coordinate complex symmetric\n", "", "must be %%MatrixMarket matrix coordinate"},
           {"coordinate real symmetric\n", "", "ends before the size"},
           {"coordinate real symmetric\n", "999999999 999999999 1\n",
            "at least one for each row"},
           {"coordinate real general\n", "2 2 3\n1 1 1\n2 2 1\n2 1 1\n", ""},
           {"array real general\n", "1 1\n1\n", "names 2 rows, the matrix has 1"}})
   {
      write_whole("m.mtx", banner + m.file + m.content);
      write_whole("m.dofs", "1 1 0 0\n1 2 0 0\n");
      if (*m.says == 0) { EXPECT_NO_THROW(read_stiffness("m.mtx")); }
      else
      {
         expect_input_error([&] { read_stiffness("m.mtx"); }, m.says);
      }
   }
   write_whole("m.mtx", banner + "array real general\n2 2\n1\n0\n0\n1\n");
   for (const Mistake &m : std::vector<Mistake>{
           {"", "1 1 0 0\n1 2 1 0\n", "node 1 is at (1, 0), and was at (0, 0) before"},
           {"", "1 1 0 0\n1 1 0 0\n",
            "direction 1 of node 1 has a second row, 1, must have one only"},
           {"", "1 1 0 0\n1 2 0\n", "line 2: '1 2 0', must be node, direction, x and y"},
           {"", "1 1 0 0\n1 2 0 0\nfixed 3 1\n", "node 3 direction 1 has no row"},
           {"", "1 1 0 0\n1 2 0 0\nhold 3 1\n", "'hold 3 1', must be axisymmetric"},
           {"", "1 1 0 0\n1 2 0 0\nset A 4\n", "a set has node 4"},
           {"", "1 1 0 0\n1 2 0 0\nforce P 1 1 1\ndisplacement P 1 2 1\n",
            "forces and displacements"}})
   {
      write_whole("m.dofs", m.content);
      expect_input_error([&] { read_stiffness("m.mtx"); }, m.says);
   }
   write_whole("m.sti", "1 1 1.\n2 2 1.\n");
   write_whole("m.dof", "1.1\n1.2\n");
   write_whole("again.inp", "*INCLUDE, INPUT=m.inp\n");
   for (const Mistake &m : std::vector<Mistake>{
           {"", "", "there is no *NODE"},
           {"", "*NODE\n1, 0.\n", "line 2: *NODE has 2 fields"},
           {"", "*NODE\n1, 0., 0., 3.\n2, 1., 0.\n",
            "node 2 is at z = 0, the first one at 3, all must be in one plane"},
           {"", "*NODE\n1, 0., 0.\n*NGEN\n1, 5\n", "*NGEN generates or moves nodes"},
           {"", "*NODE, INPUT=nodes.txt\n", "*NODE has its lines in a file of its own"},
           {"", "*NODE, SYSTEM=C\n1, 0., 0.\n", "cylindrical coordinates"},
           {"", "*NODE\n1, 0., 0.\n1, 0., 0.\n", "line 3: node 1 is there a second time"},
           {"", "*NODE\n1, 0., 0.\n*ELEMENT, TYPE=CPE4\n1, 1, 2, 3, 4\n",
            "element 1 has node 2"},
           {"", "*NODE\n1, 0., 0.\n*ELEMENT, TYPE=CPE4\n1, 1\n",
            "element 1 is a CPE4 of 1 nodes, must have 4"},
           {"",
            "*NODE\n1, 0., 0.\n2, 1., 0.\n3, 0., 1.\n*ELEMENT, TYPE=CPE3\n5, 1, 2, 3\n8, 2, 3, "
            "1\n",
            "file 'm.inp': element 8 and element 5 lie on the same side of their common edge"},
           {"", "*NODE\n1, 0., 0.\n*TRANSFORM\n", "*TRANSFORM turns directions"},
           {"", "*NODE\n1, 0., 0.\n*EQUATION\n", "*EQUATION makes nodes depend on others"},
           {"", "*NODE\n1, 0., 0.\n*Rigid body, ref node=1\n",
            "*RIGID BODY makes nodes depend"},
           {"", "*NODE\n1, 0., 0.\n*NSET, NSET=A\nB\n", "line 4: there is no set 'B'"},
           {"", "*NODE\n1, 0., 0.\n*NSET, NSET=A, GENERATE\n1, 2000000000\n",
            "between nodes that are there"},
           {"", "*NODE\n1, 0., 0.\n*SOLID SECTION\n2.\n",
            "the thickness of *SOLID SECTION is 2, must be 1, as stiffness and forces are per "
            "thickness"},
           {"", "*NODE\n1, 0., 0.\n*CLOAD\n1, 3, 1.\n", "'CLOAD1' loads node 1 direction 3"},
           {"", "*NODE\n1, 0., 0.\n2, 1., 0.\n*BOUNDARY\n2, 1, 1, 0.5\n",
            "'BOUNDARY1' moves node 2"},
           {"", "*INCLUDE, INPUT=m.inp\n", "is within that file itself, must name another"},
           {"", "*INCLUDE, INPUT=again.inp\n", "more than 10 deep"},
           {"", "*INCLUDE\n", "*INCLUDE has no INPUT"},
           {"", "*PART, NAME=A\n*NODE\n1, 0., 0.\n*PART, NAME=B\n*NODE\n1, 0., 0.\n",
            "has 2 parts, A, B"},
           {"", "*PART, NAME=A\n*PART, NAME=A\n", "*PART 'A' is there a second time"},
           {"",
            "*PART, NAME=A\n*NODE\n1, 0., 0.\n*END PART\n*INSTANCE, NAME=A-1, PART=A\n"
            "*INSTANCE, NAME=A-2, PART=A\n",
            "a second *INSTANCE begins"},
           {"", "*INSTANCE, NAME=A, PART=B\n1., 0., 0.\n", "is of the part 'B', which must"}})
   {
      write_whole("m.inp", m.content);
      expect_input_error([&] { read_stiffness("m.sti"); }, m.says);
   }
   write_whole("m.inp", deck);
   write_whole("m.dof", "1,1\n");
   expect_input_error([&] { read_stiffness("m.sti"); }, "'1,1', must be node.direction");
   write_whole("m.dof", "1.1\n");
   expect_input_error([&] { read_stiffness("m.sti"); }, "entry (2, 2), must be within 1×1");
   std::filesystem::remove("m.dof");
   expect_input_error([&] { read_stiffness("m.sti"); }, "cannot read file 'm.dof'");
}

/// ABAQUS writes the matrices of job.inp into job_STIF1.mtx, job_STIF2.mtx, …
/// Two nodes whose masses are their numbers, with a mass between both, in files of each
/// kind. Rows of the mass stand in another order than those of the stiffness.
TEST_F(Exchange, MassesOfEachKind)
{
   const std::string deck = "*NODE\n1, 0., 0.\n2, 1., 0.\n";
   write_whole("m.inp", deck);
   write_whole("m.mtx", "1,1,1,1,4.\n1,2,1,2,4.\n2,1,2,1,4.\n2,2,2,2,4.\n");
   const auto expect_masses = [](const NodalStiffness &body)
   {
      ASSERT_EQ(body.M.rows(), body.K.rows());
      for (std::size_t row = 0; row < body.dofs.size(); ++row)
      {
         const int k = static_cast<int>(row);
         EXPECT_EQ(body.M.coeff(k, k), body.dofs[row].node);
      }
      EXPECT_EQ(body.M.sum(), 2 * (1 + 2) + 2 * 0.25);
      const auto at = body.rows();
      EXPECT_EQ(body.M.coeff(at.at({1, 2}), at.at({2, 2})), 0.25);
   };
   NodalStiffness body = read_stiffness("m.mtx");
   EXPECT_EQ(body.M.rows(), 0);
   write_whole("m_MASS1.mtx", "2,2,2,2,2.\n2,1,2,1,2.\n2,2,1,2,.25\n1,2,1,2,1.\n1,1,1,1,1.\n");
   read_mass(body, "m_MASS1.mtx");
   expect_masses(body);
   // CalculiX numbers the rows in its .dof file.
   body.M = {};
   write_whole("m.dof", "2.2\n2.1\n1.2\n1.1\n");
   write_whole("m.mas", "1 1 2.\n2 2 2.\n3 3 1.\n4 4 1.\n3 1 .25\n");
   read_mass(body, "m.mas");
   expect_masses(body);
   // MatrixMarket has the rows of the stiffness.
   body.M = {};
   const auto at = body.rows();
   const std::string i = std::to_string(at.at({1, 2}) + 1),
                     j = std::to_string(at.at({2, 2}) + 1);
   std::string entries;
   for (std::size_t row = 0; row < 4; ++row)
   {
      const std::string k = std::to_string(row + 1);
      entries += k + " " + k + " " + std::to_string(body.dofs[row].node) + "\n";
   }
   write_whole("n.mtx", "%%MatrixMarket matrix coordinate real symmetric\n4 4 5\n" + entries +
                           i + " " + j + " .25\n");
   read_mass(body, "n.mtx");
   expect_masses(body);
   // write_npz() writes both.
   Eigen::MatrixXd dense(body.M);
   write_npz("n.npz", body, dense);
   body.M = {};
   read_mass(body, "n.npz");
   expect_masses(body);
   // Each part has its own.
   body.M.coeffRef(at.at({1, 2}), at.at({2, 2})) = 0;
   body.M.coeffRef(at.at({2, 2}), at.at({1, 2})) = 0;
   double sum = 0;
   for (const NodalStiffness &part : body.parts())
   {
      ASSERT_EQ(part.M.rows(), part.K.rows());
      sum += part.M.sum();
   }
   EXPECT_EQ(sum, 6);

   // A mass of another name has the deck and the rows of the stiffness.
   body.M = {};
   write_whole("other.mas", "1 1 2.\n2 2 2.\n3 3 1.\n4 4 1.\n3 1 .25\n");
   read_mass(body, "other.mas");
   expect_masses(body);
   body.M = {};
   write_whole("other.mas", "1 1 2.\n2 2 2.\n3 3 1.\n");
   expect_input_error([&] { read_mass(body, "other.mas"); },
                      "mass 'other.mas' has no entry for");
   EXPECT_EQ(body.M.rows(), 0);
   write_whole("other.mas", "");
   expect_input_error([&] { read_mass(body, "other.mas"); }, "is the file complete?");

   write_whole("n.mtx", "%%MatrixMarket matrix coordinate real symmetric\n1 1 1\n1 1 1.\n");
   expect_input_error([&] { read_mass(body, "n.mtx"); }, "has 1 rows, must have 4");
   write_whole("m.mas", "1 1 -2.\n2 2 2.\n3 3 1.\n4 4 1.\n");
   expect_input_error([&] { read_mass(body, "m.mas"); },
                      "the diagonal of a mass must be positive");
   write_whole("m_MASS1.mtx", "3,2,3,2,2.\n");
   expect_input_error([&] { read_mass(body, "m_MASS1.mtx"); },
                      "which has no row in the stiffness");
   write_whole("m_MASS1.mtx", "1,1,1,1,1.\n-1,1,-1,1,2.\n");
   expect_input_error([&] { read_mass(body, "m_MASS1.mtx"); }, "an internal node has a mass");
   expect_input_error([&] { read_mass(body, "m.sti"); },
                      "must end with .mas, .mtx, .npy or .npz");
   write_npz("n.npz", body);
   expect_input_error([&] { read_mass(body, "n.npz"); }, "its matrix is a stiffness");
}

TEST_F(Exchange, ADeckAndItsMatrixFindEachOther)
{
   write_whole("job.inp", "*NODE\n1, 0., 2.\n2, 1., 2.\n");
   write_whole("job_STIF2.mtx", "1,1,1,1,1.\n1,2,1,2,2.\n2,1,2,1,3.\n2,2,2,2,4.\n");
   EXPECT_EQ(read_stiffness("job_STIF2.mtx").places.at(2), Eigen::Vector2d(1, 2));
   // The second matrix is not that of the deck's only step.
   expect_input_error([] { matrix_of_deck("job.inp"); },
                      "there is no stiffness beside it, must be one of");
   std::filesystem::copy("job_STIF2.mtx", "job_STIF1.mtx");
   EXPECT_EQ(matrix_of_deck("job.inp"), "job_STIF1.mtx");
   write_whole("job.sti", "1 1 1.\n");
   expect_input_error([] { matrix_of_deck("job.inp"); },
                      "there are 2 stiffnesses, job.sti, job_STIF1.mtx");
   expect_input_error([] { matrix_of_deck("none.inp"); }, "cannot read file 'none.inp'");
   expect_input_error([] { matrix_of_deck("job.sti"); }, "must end with .inp");
   expect_input_error([] { read_stiffness("none_STIF1.mtx"); }, "none_STIF1.mtx");
}

/// Whatever becomes of a file, it is read or refused.
TEST_F(Exchange, DamagedFilesAreReadOrRefused)
{
   std::mt19937 random(5);
   const auto below = [&](std::size_t end) { return random() % end; };
   int refused = 0, read = 0;
   for (const char *job : {"laps.sti laps.inp laps.dof", "abaqus.mtx abaqus.inp",
                           "superelement.mtx superelement.inp", "rows.mtx rows.dofs",
                           "rows.npy rows.dofs", "rows_csr.npz rows.dofs"})
   {
      std::istringstream names(job);
      std::vector<std::string> files, contents;
      for (std::string name; names >> name;)
      {
         std::ifstream in(folder + name, std::ios::binary);
         files.push_back(name.rfind("rows", 0) == 0 && name.find("dofs") != name.npos
                            ? "damaged.dofs"
                            : "damaged" + name.substr(name.find('.')));
         contents.emplace_back(std::istreambuf_iterator<char>(in),
                               std::istreambuf_iterator<char>());
      }
      const std::vector<std::string> bits = {
         "-1", "1e999", "nan",     "*",          ",", ",,", "\n", "99999999999",
         "0",  ".",     "*STEP\n", "4294967295", "=", "\"", "\t"};
      for (int trial = 0; trial < 100; ++trial)
      {
         for (std::size_t f = 0; f < files.size(); ++f) { write_whole(files[f], contents[f]); }
         const std::size_t f = below(files.size());
         std::string text = contents[f];
         const std::size_t at = below(text.size());
         switch (below(5))
         {
         case 0:
            text.resize(at);
            break;
         case 1:
            text[at] = static_cast<char>(random());
            break;
         case 2:
            text.insert(at, bits[below(bits.size())]);
            break;
         case 3:
            text.erase(at, 1 + below(40));
            break;
         default:
            text.replace(at, 1, bits[below(bits.size())]);
         }
         write_whole(files[f], text);
         try
         {
            const NodalStiffness result = read_stiffness(files[0]);
            for (const NodalStiffness &part : result.parts())
            {
               for (const auto &[set, nodes] : part.sets)
               {
                  try
                  {
                     part.contact_line(nodes);
                  }
                  catch (const InputError &)
                  {
                  }
               }
            }
            ++read;
         }
         catch (const InputError &error)
         {
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
            ++refused;
         }
      }
   }
   EXPECT_GT(refused, 100);
   EXPECT_GT(read, 20);
}

/// A square 0 1 2 3 and beside it, on its side 1 2, a triangle with the corner 4: five outer
/// edges, the body on their left whichever way the elements turn; of order 2 with the middle
/// between.
TEST(OuterEdges, OfASquareAndATriangle)
{
   NodalStiffness::Places places = {
      {0, {0, 0}}, {1, {1, 0}}, {2, {1, 1}}, {3, {0, 1}}, {4, {2, 0.5}}};
   const std::vector<NodalStiffness::Nodes> expected = {{0, 1}, {3, 0}, {1, 4}, {2, 3}, {4, 2}};
   EXPECT_EQ(outer_edges({{0, 1, 2, 3}, {1, 4, 2}}, places), expected);
   EXPECT_EQ(outer_edges({{3, 2, 1, 0}, {2, 4, 1}}, places), expected);

   const auto middle = [&](int node, int a, int b)
   { places[node] = 0.5 * (places.at(a) + places.at(b)); };
   middle(5, 1, 4);
   middle(6, 4, 2);
   middle(7, 2, 1);
   const std::vector<NodalStiffness::Nodes> curved = {{2, 7, 1}, {1, 5, 4}, {4, 6, 2}};
   std::vector<NodalStiffness::Nodes> found = outer_edges({{1, 4, 2, 5, 6, 7}}, places);
   EXPECT_TRUE(std::is_permutation(found.begin(), found.end(), curved.begin(), curved.end()));
   expect_input_error(
      [&] {
         outer_edges({{1, 4, 2, 6, 5, 7}}, places);
      },
      "element 0: node 6 is not between its corners 1 and 4");
   expect_input_error(
      [&] {
         outer_edges({{0, 1, 2}, {0, 1}}, places);
      },
      "element 1 has 2 nodes");
   expect_input_error([&] { outer_edges({{0, 1, 9}}, places); }, "has node 9");
   // A quadrilateral with a corner twice is a triangle; an element that is there twice hides
   // none.
   EXPECT_EQ(outer_edges({{0, 1, 2, 3}, {1, 4, 4, 2}}, places), expected);
   expect_input_error(
      [&] {
         outer_edges({{0, 1, 2, 3}, {1, 2, 3, 0}}, places, {7, 9});
      },
      "element 9 and element 7 lie on the same side of their common edge from node 1 to 2");
}

} // namespace
