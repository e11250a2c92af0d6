//! ampco
