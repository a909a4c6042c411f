#include <algorithm>
#include <cattaneo/exchange/write_stiffness.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/whole_file.hpp>
#include <cstdio>
#include <filesystem>
#include <set>
#include <sstream>

namespace cattaneo
{

using Eigen::Index;
using Arrays = std::map<std::string, Eigen::MatrixXd>;

namespace
{

void add_mass(Arrays &arrays, const Eigen::MatrixXd &M, Index size)
{
   if (M.size() == 0) { return; }
   require(M.rows() == size && M.cols() == size, "mass matrix: it is ", M.rows(), "×", M.cols(),
           ", must be ", size, "×", size, " like the stiffness");
   arrays["M"] = M;
}

void require_forces(const std::string &file, const NodalStiffness &stiffness)
{
   for (const BodyLoad &load : stiffness.loads)
   {
      require(load.control == Control::force, "file '", file, "': load '", load.name,
              "' prescribes displacements, but such a file has forces only: condense the body, "
              "then all its loads "
              "are forces");
   }
}

std::string beside(const std::string &file, const char *ending)
{
   require(std::filesystem::path(file).extension() == ".mtx", "file '", file,
           "' must end with .mtx");
   return std::filesystem::path(file).replace_extension(ending).string();
}

/// Blanks would end a name.
void require_word(const std::string &what, const std::string &name)
{
   require(!name.empty() && name.find_first_of(" \t\r\n,#*=") == std::string::npos, what, " '",
           name, "', must be one word without , # * and = for a file");
}

/// Sets by their names, without nodes that have no row and so no place in the file.
NodalStiffness::Sets written_sets(const NodalStiffness &stiffness)
{
   std::set<int> known;
   for (const NodeDof &dof : stiffness.dofs) { known.insert(dof.node); }
   NodalStiffness::Sets written;
   for (const auto &[set, nodes] : stiffness.sets)
   {
      require_word("set", set);
      for (int node : nodes)
      {
         if (known.count(node) == 1) { written[set].push_back(node); }
      }
   }
   return written;
}

/// Nodes that are counted from 0 are counted from 1 in the file, as in other programs.
NodalStiffness numbered_from_one(NodalStiffness stiffness)
{
   int least = 1;
   for (const NodeDof &dof : stiffness.dofs) { least = std::min(least, dof.node); }
   const int more = 1 - least;
   if (more == 0) { return stiffness; }
   for (NodeDof &dof : stiffness.dofs) { dof.node += more; }
   NodalStiffness::Places places;
   for (const auto &[node, place] : stiffness.places) { places[node + more] = place; }
   stiffness.places = std::move(places);
   for (auto &[set, nodes] : stiffness.sets)
   {
      for (int &node : nodes) { node += more; }
   }
   return stiffness;
}

/// NumPy and read_stiffness() recognize the array by this name.
void require_npz(const std::string &file)
{
   require(std::filesystem::path(file).extension() == ".npz", "write_npz: file '", file,
           "' must end with .npz");
}

/// InputError for a body in space.
void require_flat(const std::string &file, const NodalStiffness &stiffness)
{
   require(stiffness.formulation != Formulation::space, "file '", file, "': the stiffness '",
           stiffness.name, "' is in space, use write_matrix_market() for it");
}

} // namespace

void write_npz(const std::string &file, const NodalStiffness &stiffness,
               const Eigen::MatrixXd &M)
{
   require_npz(file);
   stiffness.validate();
   require_forces(file, stiffness);
   const auto size = static_cast<Index>(stiffness.dofs.size()),
              count = static_cast<Index>(stiffness.loads.size());
   require(size < 23000, "write_npz: K of file '", file, "' has ", size,
           " rows, and would be written with all of its entries; an array must have less than "
           "23000: use write_matrix_market()");
   const int dimension = cattaneo::dimension(stiffness.formulation);
   Eigen::MatrixXd loads(size, count), dofs(size, 2), places(size, dimension);
   for (Index k = 0; k < count; ++k) { loads.col(k) = stiffness.loads[k].values; }
   for (Index row = 0; row < size; ++row)
   {
      const NodeDof &dof = stiffness.dofs[row];
      dofs.row(row) << dof.node, dof.direction;
      places.row(row) = stiffness.place(dof.node).head(dimension).transpose();
   }
   const Eigen::VectorXd fixed =
      Eigen::Map<const Eigen::VectorXi>(stiffness.fixed.data(), stiffness.fixed.size())
         .cast<double>();
   Arrays arrays = {{"K", Eigen::MatrixXd(stiffness.K)},
                    {"loads", loads},
                    {"dofs", dofs},
                    {"places", places},
                    {"fixed", fixed}};
   const Eigen::MatrixXd so = Eigen::MatrixXd::Ones(1, 1);
   if (stiffness.formulation == Formulation::axisymmetric) { arrays["axisymmetric"] = so; }
   if (stiffness.supports_left_out) { arrays["supports_left_out"] = so; }
   for (Index k = 0; k < count; ++k)
   {
      require_word("load", stiffness.loads[k].name);
      arrays["load " + stiffness.loads[k].name] = k * so;
   }
   for (const auto &[set, nodes] : written_sets(stiffness))
   {
      arrays["set " + set] =
         Eigen::Map<const Eigen::VectorXi>(nodes.data(), nodes.size()).cast<double>();
   }
   if (!stiffness.faces.empty())
   {
      // One row per face, filled up with -1.
      std::size_t most = 0;
      for (const NodalStiffness::Nodes &face : stiffness.faces)
      {
         most = std::max(most, face.size());
      }
      Eigen::MatrixXd faces =
         Eigen::MatrixXd::Constant(stiffness.faces.size(), static_cast<Index>(most), -1);
      for (std::size_t f = 0; f < stiffness.faces.size(); ++f)
      {
         const NodalStiffness::Nodes &face = stiffness.faces[f];
         for (std::size_t a = 0; a < face.size(); ++a) { faces(f, a) = face[a]; }
      }
      arrays["faces"] = faces;
   }
   add_mass(arrays, M, size);
   write_npz(file, arrays);
}

void write_npz(const std::string &file, const ReducedProblem &problem, const Eigen::MatrixXd &M)
{
   require_npz(file);
   problem.validate();
   require_coulomb(problem, "write_npz");
   const auto count = static_cast<Index>(problem.patterns.size());
   Eigen::MatrixXd loads(problem.K.rows(), count);
   for (Index k = 0; k < count; ++k)
   {
      loads.col(k) << problem.patterns[k].q, problem.patterns[k].p;
   }
   Arrays arrays = {{"K", problem.K},
                    {"loads", loads},
                    {"H", problem.H},
                    {"gap", problem.gap},
                    {"friction", problem.friction},
                    {"weights", problem.weights},
                    {"position", problem.position}};
   add_mass(arrays, M, problem.K.rows());
   write_npz(file, arrays);
}

void write_matrix_market(const std::string &file, const NodalStiffness &stiffness)
{
   stiffness.validate();
   const std::string names = beside(file, ".dofs");
   std::ostringstream matrix, dofs;
   Index count = 0;
   for (Index row = 0; row < stiffness.K.rows(); ++row)
   {
      for (NodalStiffness::Matrix::InnerIterator entry(stiffness.K, row); entry; ++entry)
      {
         if (entry.col() > row) { continue; }
         ++count;
         matrix << row + 1 << ' ' << entry.col() + 1 << ' ' << exact_text(entry.value())
                << '\n';
      }
   }
   if (stiffness.formulation == Formulation::axisymmetric) { dofs << "axisymmetric\n"; }
   if (stiffness.supports_left_out) { dofs << "supports_left_out\n"; }
   const bool in_space = stiffness.formulation == Formulation::space;
   dofs << (in_space ? "# node direction x y z\n" : "# node direction x y\n");
   const auto called = [&](std::size_t row)
   {
      const NodeDof &dof = stiffness.dofs[row];
      return std::to_string(dof.node) + ' ' + std::to_string(dof.direction);
   };
   for (std::size_t row = 0; row < stiffness.dofs.size(); ++row)
   {
      const Eigen::Vector2d &place = stiffness.places.at(stiffness.dofs[row].node);
      dofs << called(row) << ' ' << exact_text(place[0]) << ' ' << exact_text(place[1]);
      if (in_space) { dofs << ' ' << exact_text(stiffness.z.at(stiffness.dofs[row].node)); }
      dofs << '\n';
   }
   for (const auto &[set, nodes] : written_sets(stiffness))
   {
      dofs << "set " << set;
      for (int node : nodes) { dofs << ' ' << node; }
      dofs << '\n';
   }
   for (const NodalStiffness::Nodes &face : stiffness.faces)
   {
      dofs << "face";
      for (int node : face) { dofs << ' ' << node; }
      dofs << '\n';
   }
   for (int row : stiffness.fixed) { dofs << "fixed " << called(row) << '\n'; }
   for (const BodyLoad &load : stiffness.loads)
   {
      require_word("load", load.name);
      for (Index row = 0; row < load.values.size(); ++row)
      {
         if (load.values[row] == 0) { continue; }
         dofs << (load.control == Control::force ? "force " : "displacement ") << load.name
              << ' ' << called(row) << ' ' << exact_text(load.values[row]) << '\n';
      }
   }
   std::ostringstream head;
   head << "%%MatrixMarket matrix coordinate real symmetric\n"
        << stiffness.K.rows() << ' ' << stiffness.K.rows() << ' ' << count << '\n';
   write_whole(names, dofs.str());
   write_whole(file, head.str() + matrix.str());
}

void write_abaqus(const std::string &file, const NodalStiffness &given)
{
   require_flat(file, given);
   given.validate();
   const NodalStiffness stiffness = numbered_from_one(given);
   require_forces(file, stiffness);
   const std::string deck_file = beside(file, ".inp");
   // In this file the rows of a node follow each other.
   std::map<int, std::vector<std::size_t>> rows;
   for (std::size_t row = 0; row < stiffness.dofs.size(); ++row)
   {
      rows[stiffness.dofs[row].node].push_back(row);
   }
   std::ostringstream element, deck;
   element << "*USER ELEMENT, NODES=" << rows.size() << ", TYPE=U1, LINEAR\n** ELEMENT NODES\n";
   if (stiffness.formulation == Formulation::axisymmetric) { deck << "** AXISYMMETRIC\n"; }
   deck << "*NODE\n";
   std::ostringstream directions, connectivity;
   std::vector<int> order, last;
   int position = 0;
   for (auto &[node, own] : rows)
   {
      std::sort(own.begin(), own.end(),
                [&](std::size_t a, std::size_t b)
                { return stiffness.dofs[a] < stiffness.dofs[b]; });
      std::vector<int> of_node;
      for (std::size_t row : own)
      {
         order.push_back(static_cast<int>(row));
         of_node.push_back(stiffness.dofs[row].direction);
      }
      if (of_node != last)
      {
         if (position > 0) { directions << position + 1 << ", "; }
         for (std::size_t k = 0; k < of_node.size(); ++k)
         {
            directions << (k > 0 ? ", " : "") << of_node[k];
         }
         directions << '\n';
         last = of_node;
      }
      const Eigen::Vector2d &place = stiffness.places.at(node);
      deck << node << ", " << exact_text(place[0]) << ", " << exact_text(place[1]) << '\n';
      element << "** " << node << '\n';
      connectivity << (position % 15 == 14 ? ",\n" : ", ") << node;
      ++position;
   }
   element << directions.str() << "*MATRIX, TYPE=STIFFNESS\n";
   const Eigen::MatrixXd K = Eigen::MatrixXd(stiffness.K)(order, order);
   for (Index i = 0; i < K.rows(); ++i)
   {
      for (Index j = 0; j <= i; ++j)
      {
         element << exact_text(K(i, j)) << (j == i || j % 4 == 3 ? "\n" : ", ");
      }
   }
   deck << "*INCLUDE, INPUT=" << std::filesystem::path(file).filename().string()
        << "\n*ELEMENT, TYPE=U1, ELSET=CONDENSED\n1" << connectivity.str()
        << "\n*UEL PROPERTY, ELSET=CONDENSED\n";
   for (const auto &[set, nodes] : written_sets(stiffness))
   {
      deck << "*NSET, NSET=" << set << '\n';
      for (int node : nodes) { deck << node << '\n'; }
   }
   const auto called = [&](std::size_t row)
   {
      const NodeDof &dof = stiffness.dofs[row];
      return std::to_string(dof.node) + ", " + std::to_string(dof.direction);
   };
   if (!stiffness.fixed.empty()) { deck << "*BOUNDARY\n"; }
   for (int row : stiffness.fixed) { deck << called(row) << '\n'; }
   for (const BodyLoad &load : stiffness.loads)
   {
      deck << "** " << load.name << "\n*CLOAD\n";
      for (Index row = 0; row < load.values.size(); ++row)
      {
         if (load.values[row] == 0) { continue; }
         deck << called(row) << ", " << exact_text(load.values[row]) << '\n';
      }
   }
   write_whole(deck_file, deck.str());
   write_whole(file, element.str());
}

namespace
{

/// A number in the 16 columns of a wide field, with as many digits as fit.
std::string wide(double value, char exponent)
{
   char text[32];
   for (int digits = value < 0 ? 9 : 10; digits > 0; --digits)
   {
      if (std::snprintf(text, sizeof text, "%.*E", digits, value) <= 16) { break; }
   }
   std::string field = text;
   if (const std::size_t at = field.find('E'); at != std::string::npos)
   {
      field[at] = exponent;
   }
   return std::string(16 - field.size(), ' ') + field;
}

std::string wide(int number)
{
   const std::string field = std::to_string(number);
   return std::string(16 - field.size(), ' ') + field;
}

} // namespace

void write_nastran(const std::string &file, const NodalStiffness &given)
{
   require_flat(file, given);
   given.validate();
   const NodalStiffness stiffness = numbered_from_one(given);
   require_forces(file, stiffness);
   std::ostringstream text;
   text << "$ stiffness of a body"
        << (stiffness.formulation == Formulation::axisymmetric
               ? " of revolution, of the whole circumference: r, z in the place of x, y\n"
               : "\n");
   std::map<int, Eigen::Vector2d> places;
   for (const NodeDof &dof : stiffness.dofs)
   {
      places[dof.node] = stiffness.places.at(dof.node);
   }
   for (const auto &[node, place] : places)
   {
      text << "GRID*   " << wide(node) << wide(0) << wide(place[0], 'E') << wide(place[1], 'E')
           << "\n*       " << wide(0.0, 'E') << '\n';
   }
   text << "DMIG    KAAX           0       6       2       0\n";
   for (Index column = 0; column < stiffness.K.rows(); ++column)
   {
      const NodeDof &of = stiffness.dofs[column];
      text << "DMIG*   KAAX            " << wide(of.node) << wide(of.direction) << '\n';
      for (NodalStiffness::Matrix::InnerIterator entry(stiffness.K, column); entry; ++entry)
      {
         if (entry.col() < column || entry.value() == 0) { continue; }
         const NodeDof &at = stiffness.dofs[entry.col()];
         text << "*       " << wide(at.node) << wide(at.direction) << wide(entry.value(), 'D')
              << '\n';
      }
   }
   for (int row : stiffness.fixed)
   {
      const NodeDof &dof = stiffness.dofs[row];
      text << "SPC1*   " << wide(1) << wide(dof.direction) << wide(dof.node) << "\n*\n";
   }
   int set = 0;
   for (const BodyLoad &load : stiffness.loads)
   {
      text << "$ load " << ++set << ": " << load.name << '\n';
      for (Index row = 0; row < load.values.size(); ++row)
      {
         if (load.values[row] == 0) { continue; }
         const NodeDof &dof = stiffness.dofs[row];
         text << "FORCE*  " << wide(set) << wide(dof.node) << wide(0)
              << wide(load.values[row], 'E') << "\n*       " << wide(dof.direction == 1, 'E')
              << wide(dof.direction == 2, 'E') << wide(0.0, 'E') << '\n';
      }
   }
   write_whole(file, text.str());
}

} // namespace cattaneo
