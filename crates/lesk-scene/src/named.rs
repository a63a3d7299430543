//! Enums whose variants have names in files and commands: one list for the reader, the schema and the callers.

/// Gives an enum its names: `ALL`, `NAMES`, `name` and `FromStr`. The variants stand in the order of their declaration, the
/// default first.
macro_rules! named {
    ($Type:ident, $what:literal, $($Variant:ident: $name:literal,)*) => {
        impl $Type {
            /// All of them, the default first.
            pub const ALL: &[Self] = &[$(Self::$Variant),*];
            /// The names that scene files and commands accept, the default first.
            pub const NAMES: &[&str] = &[$($name),*];

            /// Its name in commands and files.
            pub fn name(self) -> &'static str {
                Self::NAMES[self as usize]
            }
        }

        impl std::str::FromStr for $Type {
            type Err = $crate::Problem;

            fn from_str(name: &str) -> Result<Self, $crate::Problem> {
                let found = Self::ALL.iter().copied().find(|x| x.name() == name);
                found.ok_or_else(|| $crate::Problem::unknown_name($what, name, Self::NAMES))
            }
        }
    };
}
pub(crate) use named;
