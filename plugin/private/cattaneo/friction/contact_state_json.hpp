#pragma once

#include <cattaneo/friction/contact_state.hpp>
#include <functional>
#include <nlohmann/json.hpp>

namespace cattaneo
{

std::vector<double> json_list(const Eigen::VectorXd &x);
Eigen::VectorXd json_vector(const nlohmann::json &j);

/// A complete state, to the last bit. InputError if a value is not finite.
nlohmann::json to_json(const ContactState &state);
/// The state that to_json() wrote. @param file its name, for InputError
ContactState contact_state(const nlohmann::json &j, const std::string &file);

/// Reads a file with this "format". @param what the kind of file that is expected, for
/// InputError, which also names a missing key
void read_state_file(const std::string &what, const std::string &file,
                     const std::string &format,
                     const std::function<void(const nlohmann::json &)> &read);

} // namespace cattaneo
