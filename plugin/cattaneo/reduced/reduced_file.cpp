#include <algorithm>
#include <cattaneo/algebra/semidefinite.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/json_text.hpp>
#include <cattaneo/reduced/reduced_file.hpp>
#include <cattaneo/whole_file.hpp>
#include <cattaneo/words.hpp>

namespace cattaneo
{

namespace
{

const char *const format_name = "cattaneo reduced problem 2";
const char *const format_laws = "cattaneo reduced problem 3"; // only where it has such laws
const char *const format_1 = "cattaneo reduced problem 1";    // without the facts

// "axis" means any symmetry: files keep the word of the first format.
const std::vector<std::string> end_names = {"unknown", "smooth", "corner", "axis", "open"};

nlohmann::json to_json(const std::array<LineEnd, 2> &ends)
{
   return {end_names[static_cast<std::size_t>(ends[0])],
           end_names[static_cast<std::size_t>(ends[1])]};
}

std::array<LineEnd, 2> ends_from_json(const nlohmann::json &j)
{
   std::array<LineEnd, 2> ends{};
   for (std::size_t k = 0; k < 2; ++k)
   {
      const auto word = j.at(k).get<std::string>();
      const auto found = std::find(end_names.begin(), end_names.end(), word);
      require(found != end_names.end(), "reduced problem: the end of a line is '", word,
              "', must be unknown, smooth, corner, axis or open");
      ends[k] = static_cast<LineEnd>(found - end_names.begin());
   }
   return ends;
}

const std::string &writable(const char *what, const std::string &name)
{
   require(is_utf8(name), "reduced problem: the name of ", what, " '", name,
           "' must be UTF-8 to be written to a file");
   return name;
}

/// Rows, columns and the entries column by column.
template <class Matrix>
nlohmann::json to_json(const Matrix &M)
{
   return {{"rows", M.rows()},
           {"cols", M.cols()},
           {"values", std::vector<typename Matrix::Scalar>(M.data(), M.data() + M.size())}};
}

/// The JSON library would cut 3.5 to 3.
Eigen::Index whole_number(const nlohmann::json &j, const char *key)
{
   const nlohmann::json &value = j.at(key);
   require(value.is_number_integer(), "reduced problem: ", key, " is ", value.dump(),
           ", must be a whole number");
   return value;
}

template <class Matrix>
void from_json(const nlohmann::json &j, Matrix &M)
{
   const nlohmann::json &entries = j.at("values");
   for (const nlohmann::json &value : entries)
   {
      require(!std::is_integral_v<typename Matrix::Scalar> || value.is_number_integer(),
              "reduced problem: an entry of a table of whole numbers is ", value.dump());
   }
   const auto values = entries.get<std::vector<typename Matrix::Scalar>>();
   const Eigen::Index rows = whole_number(j, "rows"), cols = whole_number(j, "cols");
   // A division, because a product could overflow.
   const auto count = static_cast<Eigen::Index>(values.size());
   require(rows >= 0 && cols >= 0 &&
              (cols == 0 ? count == 0 : count % cols == 0 && rows == count / cols),
           "reduced problem: ", values.size(), " entries for a matrix of ", rows, "×", cols);
   M.resize(rows, cols);
   std::copy(values.begin(), values.end(), M.data());
}

/// Chains of a file of format 1, which does not state them: one chain of all nodes, or a new
/// one wherever the arc length, if there is one, does not grow.
std::vector<ContactChain> found_chains(const Eigen::VectorXd &arc_length, Eigen::Index nodes)
{
   std::vector<ContactChain> chains;
   const bool known = arc_length.size() == nodes;
   for (Eigen::Index i = 0; i < nodes; ++i)
   {
      if (i == 0 || (known && arc_length[i] <= arc_length[i - 1]))
      {
         chains.emplace_back().first = i;
      }
      ++chains.back().nodes;
   }
   return chains;
}

void require_all_motions(const ReducedProblem &problem)
{
   require_semidefinite(problem);
   require_all_motions_stated(problem);
}

} // namespace

void save(const ReducedProblem &problem, const std::string &file)
{
   problem.validate();
   require_all_motions(problem);
   nlohmann::json j = {{"format", format_name},
                       {"coupled", problem.coupled},
                       {"A", to_json(Eigen::MatrixXd(problem.A()))},
                       {"B", to_json(Eigen::MatrixXd(problem.B()))},
                       {"C", to_json(Eigen::MatrixXd(problem.C()))},
                       {"H", to_json(problem.H)},
                       {"gap", to_json(problem.gap)},
                       {"friction", to_json(problem.friction)},
                       {"weights", to_json(problem.weights)},
                       {"arc_length", to_json(problem.arc_length)},
                       {"position", to_json(problem.position)},
                       {"dofs", to_json(problem.dofs)}};
   for (const LoadPattern &pattern : problem.patterns)
   {
      j["patterns"].push_back({{"name", writable("pattern", pattern.name)},
                               {"displacement", pattern.control == Control::displacement},
                               {"q", to_json(pattern.q)},
                               {"p", to_json(pattern.p)}});
      const LoadSize &size = pattern.size;
      if (size.kind.empty()) { continue; }
      j["patterns"].back()["size"] = {{"kind", writable("kind of load", size.kind)},
                                      {"value", size.value},
                                      {"direction", size.direction},
                                      {"place", writable("place", size.place)}};
   }
   if (!problem.laws.empty())
   {
      // A reader that does not know the laws must not use `friction` in their place.
      j["format"] = format_laws;
      for (const FrictionLaw &law : problem.laws)
      {
         j["laws"].push_back(
            {{"forward", to_json(law.forward)}, {"backward", to_json(law.backward)}});
      }
   }
   j["held"] = problem.held;
   j["chains"] = nlohmann::json::array();
   for (const ContactChain &chain : problem.chains)
   {
      j["chains"].push_back({{"interface", writable("interface", chain.interface)},
                             {"first", chain.first},
                             {"nodes", chain.nodes},
                             {"loop", chain.loop},
                             {"ends", to_json(chain.ends)},
                             {"other_ends", to_json(chain.other_ends)},
                             {"bodies", chain.bodies}});
   }
   j["rigid_motions"] = to_json(problem.rigid_motions);
   // Only surfaces have a rim, so that files of lines do not change.
   if (!problem.rim.empty()) { j["rim"] = problem.rim; }
   write_whole(file, j.dump() + '\n');
}

namespace
{

/// The keys that a file may have. Without this check an unknown key would be ignored silently,
/// for instance laws of friction in a file of format 2.
void require_known_keys(const nlohmann::json &j, const std::vector<std::string> &known,
                        const std::string &of)
{
   for (const auto &item : j.items())
   {
      require(std::find(known.begin(), known.end(), item.key()) != known.end(),
              "reduced problem: ", of, " has the key '", item.key(), "', must be one of ",
              cattaneo::listed(known));
   }
}

} // namespace

static LoadSize size_from_json(const nlohmann::json &j)
{
   require_known_keys(j, {"kind", "value", "direction", "place"}, "the size of a load");
   return {j.at("kind"), j.at("value"), j.at("direction"), j.at("place")};
}

ReducedProblem load_reduced_problem(const std::string &file)
{
   ReducedProblem problem;
   try
   {
      const nlohmann::json j =
         parsed(read_whole(file, "reduced problem: "), "reduced problem: file '" + file + "'");
      const bool first = j.at("format") == format_1, with_laws = j.at("format") == format_laws;
      require(first || with_laws || j.at("format") == format_name, "reduced problem: file '",
              file, "' must have the key 'format' with the value '", format_name,
              "' (or its versions 1 or 3)");
      std::vector<std::string> keys = {"format",   "A",        "B",        "C",
                                       "H",        "gap",      "friction", "weights",
                                       "patterns", "position", "dofs",     "arc_length"};
      if (!first)
      {
         keys.insert(keys.end(), {"coupled", "held", "chains", "rigid_motions", "rim"});
      }
      if (with_laws) { keys.emplace_back("laws"); }
      require_known_keys(j, keys,
                         "file '" + file + "' of '" + j.at("format").get<std::string>() + "'");
      Eigen::MatrixXd A, B, C;
      from_json(j.at("A"), A);
      from_json(j.at("B"), B);
      from_json(j.at("C"), C);
      from_json(j.at("H"), problem.H);
      from_json(j.at("friction"), problem.friction);
      from_json(j.at("weights"), problem.weights);
      from_json(j.at("arc_length"), problem.arc_length);
      from_json(j.at("position"), problem.position);
      from_json(j.at("dofs"), problem.dofs);
      for (const nlohmann::json &p : j.value("patterns", nlohmann::json::array()))
      {
         require_known_keys(p, {"name", "displacement", "q", "p", "size"}, "a load pattern");
         LoadPattern pattern;
         pattern.name = p.at("name");
         pattern.control = p.at("displacement") ? Control::displacement : Control::force;
         from_json(p.at("q"), pattern.q);
         from_json(p.at("p"), pattern.p);
         if (p.contains("size")) { pattern.size = size_from_json(p["size"]); }
         problem.patterns.push_back(pattern);
      }
      for (const nlohmann::json &law : with_laws ? j.at("laws") : nlohmann::json::array())
      {
         require_known_keys(law, {"forward", "backward"}, "a law of friction");
         Eigen::MatrixXd forward, backward;
         from_json(law.at("forward"), forward);
         from_json(law.at("backward"), backward);
         require(forward.cols() == 2 && backward.cols() == 2,
                 "reduced problem: a law of friction has points of ", forward.cols(), " and ",
                 backward.cols(), " numbers, must be 2");
         problem.laws.push_back({forward, backward});
      }
      if (!first)
      {
         Eigen::MatrixXd motions;
         from_json(j.at("rigid_motions"), motions);
         problem.set_stiffness(A, B, C, motions);
         problem.coupled = j.at("coupled");
         for (const nlohmann::json &row : j.at("held"))
         {
            require(row.is_number_integer(), "reduced problem: a held row is ", row.dump(),
                    ", must be a whole number");
            problem.held.push_back(row);
         }
         for (const nlohmann::json &node : j.value("rim", nlohmann::json::array()))
         {
            require(node.is_number_integer(), "reduced problem: a node of the rim is ",
                    node.dump(), ", must be a whole number");
            problem.rim.push_back(node);
         }
         for (const nlohmann::json &c : j.at("chains"))
         {
            require_known_keys(
               c, {"interface", "first", "nodes", "loop", "ends", "other_ends", "bodies"},
               "a chain");
            problem.chains.push_back({c.at("interface"), whole_number(c, "first"),
                                      whole_number(c, "nodes"), c.at("loop"),
                                      ends_from_json(c.at("ends")),
                                      ends_from_json(c.at("other_ends")), c.at("bodies")});
         }
      }
      else
      {
         problem.set_stiffness(A, B, C);
         problem.chains = found_chains(problem.arc_length, problem.nodes());
      }
      from_json(j.at("gap"), problem.gap);
      require(problem.gap.size() == C.rows(), "reduced problem: gap has ", problem.gap.size(),
              " entries, must be ", C.rows());
   }
   catch (const nlohmann::json::exception &error)
   {
      constexpr int no_such_key = 403; // named between quotes
      const std::string what = error.what();
      const std::size_t from = std::min(what.find('\''), what.size()),
                        to = std::min(what.rfind('\''), what.size());
      require(error.id != no_such_key, "reduced problem: file '", file,
              "' is not a reduced problem: it lacks the key ", what.substr(from, to - from),
              "', must be a file that --save or save() wrote");
      constexpr int no_json = 101;
      require(error.id != no_json, "reduced problem: file '", file,
              "' is not a reduced problem: it is not JSON, must be a file that --save or "
              "save() wrote");
      // Behind the library's name of the error.
      throw InputError("reduced problem: file '" + file +
                       "' is not a reduced problem: " + what.substr(what.find("] ") + 2));
   }
   problem.validate();
   require_all_motions(problem);
   return problem;
}

} // namespace cattaneo
