"""Effects of tolerances of inputs on results; both packages use these modules with their own models."""

DEFAULT_SAMPLES = 1024
