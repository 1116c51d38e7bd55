// Asio's and Beast's own code, compiled here once; the layer's definitions keep it out of all other
// files.
#include <boost/asio/impl/src.hpp>
#include <boost/beast/src.hpp>
