// How the C library's heap gives memory back to the system. Elsewhere than with glibc nothing is
// done.
#pragma once

namespace tetproof::oracles {

// From now on, every large block goes back to the system when it is freed. Otherwise the heap keeps
// blocks of up to 32 MB once it has seen one, in pieces that the next one does not fit into.
void return_large_blocks();

// Gives free pages between the blocks of the heap back to the system.
void return_free_pages();

}  // namespace tetproof::oracles
