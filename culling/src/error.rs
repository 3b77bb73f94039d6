//! What can go wrong with a method, each with the remedy.

/// Why a method could not do what it was asked. Every message is one line.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The device or driver.
    #[error(transparent)]
    Engine(#[from] engine::Error),
    /// The scene.
    #[error(transparent)]
    Scene(#[from] scenes::SceneError),
    /// No method of that name.
    #[error("there is no method '{name}'; choose from: {choices}")]
    UnknownMethod {
        /// The name asked for.
        name: String,
        /// The methods there are.
        choices: String,
    },
    /// No option of that name.
    #[error("method '{method}' has no option '{option}'; it has: {choices}")]
    UnknownOption {
        /// The method.
        method: String,
        /// The option asked for.
        option: String,
        /// The options there are.
        choices: String,
    },
    /// An option's value makes no sense.
    #[error("option '{method}.{option}' cannot be '{value}': {expected}")]
    BadOption {
        /// The method.
        method: String,
        /// The option.
        option: String,
        /// The value given.
        value: String,
        /// What it may be.
        expected: String,
    },
    /// Lens flares need something that this run does not give them.
    #[error("lens flares need {needs}")]
    Flares {
        /// What they need, and how to give it.
        needs: String,
    },
    /// The method needs something that this run does not give it.
    #[error("method '{method}' needs {needs}")]
    Missing {
        /// The method.
        method: &'static str,
        /// What it needs, and how to give it.
        needs: String,
    },
}
