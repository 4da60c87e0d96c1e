// A slider that moves by itself.  It tells by "drag" its place, and whether it is let go: of a step by a key it is.
// Its name and value are those of the part that takes the focus; the toolkit gives them to the part around it.
export default {
  template: `<q-slider v-bind="$attrs" :model-value="at" @update:model-value="move" @pointerdown="hold" @pan="pan"
    role="none" :aria-label="null" :aria-orientation="null"
    :aria-valuemin="null" :aria-valuemax="null" :aria-valuenow="null" />`,
  inheritAttrs: false,
  props: { modelValue: Number },
  emits: ["drag", "update:model-value"], // the latter so that it is none of $attrs: places are told by "drag"
  data() {
    return { at: this.modelValue, held: false, panned: false };
  },
  watch: {
    modelValue(at) {
      this.at = at;
    },
  },
  mounted() {
    this.say();
  },
  updated() {
    this.say();
  },
  methods: {
    say() {
      const { min, max, "aria-label": label } = this.$attrs, part = this.$el.querySelector("[tabindex]");
      const said = { label, valuemin: min, valuemax: max, valuenow: this.at, orientation: "horizontal" };
      part.setAttribute("role", "slider");
      for (const name in said) part.setAttribute(`aria-${name}`, said[name]);
    },
    move(at) {
      this.at = at;
      this.$emit("drag", at, !this.held);
    },
    hold() {
      this.held = true;
      const up = () => this.panned || this.letGo(); // after a pan its last move comes later
      for (const end of ["pointerup", "pointercancel"]) window.addEventListener(end, up, { once: true });
    },
    pan(phase) {
      this.panned = phase === "start";
      if (this.panned) this.held = true;
      else this.letGo();
    },
    letGo() {
      if (this.held) this.$emit("drag", this.at, true);
      this.held = false;
    },
  },
};
